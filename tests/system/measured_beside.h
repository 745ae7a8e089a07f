// A run over what was measured beside the frames of a simulated sequence, against the truth.
#pragma once

#include <gtest/gtest.h>

#include "system/run_result.h"

namespace edgeslam {

class MeasuredBesideTest : public testing::Test {
 protected:
  // `sequence`: in EDGESLAM_RUN_FOLDER.
  explicit MeasuredBesideTest(const std::string& sequence)
      : input_(std::string(EDGESLAM_RUN_FOLDER) + "/" + sequence) {}

  ReplayedRun replayedWith(const std::string& name, const std::vector<std::string>& more) const {
    ReplayedRun run = replayed(input_, folder_.path(name), more);
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.messages;
    return run;
  }
  AbsoluteError errorOf(const std::string& name) const {
    return absoluteError(readTrajectory(folder_.path(name + "/trajectory.txt")),
                         readTrajectory(input_ + "/groundtruth.txt"), Alignment::similarity);
  }

  const std::string input_;
  const TemporaryFolder folder_;
};

}  // namespace edgeslam
