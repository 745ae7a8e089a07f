#include "system/bad_frames/spoilt_run.h"

#include <gtest/gtest.h>

namespace edgeslam {

std::string SpoiltRun::folderOf(const std::string& place) { return std::string(EDGESLAM_RUN_FOLDER) + "/" + place; }

Spoilt SpoiltRun::run(double least_share_within) {
  const std::string input = sequence_.write(folder_, "sequence");
  Spoilt result{replayed(input, folder_.path("result")), {}, {}};
  EXPECT_EQ(result.run.outcome.exit_code, 0) << result.run.outcome.messages;
  EXPECT_EQ(static_cast<int>(result.run.states.size()), sequence_.size());
  result.good = readMeasuredPoses(folder_.path("result"));
  const Honesty& honesty = result.honesty = honestyOf(result.good, readTrajectory(input + "/groundtruth.txt"));
  EXPECT_GE(honesty.share_within, least_share_within)
      << "beyond their bound: " << ::testing::PrintToString(honesty.outside) << ", largest error "
      << honesty.largest_error << " m";
  ::testing::Test::RecordProperty("good", honesty.poses);
  ::testing::Test::RecordProperty("share_within_percent", std::to_string(100 * honesty.share_within));
  ::testing::Test::RecordProperty("normalised_error", std::to_string(honesty.normalised_error));
  ::testing::Test::RecordProperty("median_sigma", std::to_string(honesty.median_sigma));
  ::testing::Test::RecordProperty("largest_error_mm", std::to_string(1000 * honesty.largest_error));
  return result;
}

void SpoiltRun::expectGoodWithin(const Spoilt& result, int first, int frames) {
  const int found = result.run.firstGood(first), last = static_cast<int>(result.run.states.size()) - 1;
  ASSERT_GE(found, 0) << "never found again";
  ::testing::Test::RecordProperty("frames_to_recover", found - first);
  EXPECT_LE(found - first, frames);
  EXPECT_LE(result.run.count("lost", found, last) + result.run.count("predicted", found, last), 3);
}

void SpoiltRun::expectNoneGood(const Spoilt& result, int first, int last) {
  for (const MeasuredPose& pose : result.good) {
    EXPECT_FALSE(pose.frame >= first && pose.frame <= last) << "frame " << pose.frame << " is said to be good";
  }
}

}  // namespace edgeslam
