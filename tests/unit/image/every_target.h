// Runs a test once on every instruction set that this machine has.
#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace edgeslam {

// The sets that the kernels are compiled for and the machine has. Where they are compiled for one alone, as on ARM,
// that one is called without asking.
inline int64_t everyTarget() {
  const bool one_alone = (HWY_TARGETS & (HWY_TARGETS - 1)) == 0;
  return one_alone ? HWY_TARGETS : hwy::SupportedTargets() & HWY_TARGETS;
}

// Calls `test` with the kernels bound to each set in turn, then to the best again.
template <typename Test>
void onEveryTarget(Test test) {
  const int64_t all = everyTarget();
  for (int64_t left = all; left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    SCOPED_TRACE(hwy::TargetName(target));
    test();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(all);
}

}  // namespace edgeslam
