// The end of what was measured, where that alone is looked at.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam {

// From the first sample at `begin_ns` of its clock or after it. Times ascend.
inline std::vector<InertialSample> samplesSince(const std::vector<InertialSample>& samples, std::int64_t begin_ns) {
  const auto is_before = [](const InertialSample& sample, std::int64_t time_ns) { return sample.time_ns < time_ns; };
  return {std::lower_bound(samples.begin(), samples.end(), begin_ns, is_before), samples.end()};
}

}  // namespace edgeslam
