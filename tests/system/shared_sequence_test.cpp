// The sequences that are kept beside the source folder, where they are; their README says what each is for. Bounds are
// the "must" values of its targets.json.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/evaluation.h"
#include "evaluation/trajectory.h"
#include "system/bad_frames/measured_poses.h"
#include "system/program.h"
#include "system/surfaces.h"

namespace edgeslam {
namespace {

struct Expected {
  std::string sequence;
  double error_m;
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.sequence; }

class SharedSequence : public ::testing::TestWithParam<Expected> {};

TEST_P(SharedSequence, StaysWithinItsBounds) {
  const std::string input = std::string(EDGESLAM_SOURCE_DIR) + "/../shared/data/" + GetParam().sequence;
  if (!std::filesystem::exists(input)) GTEST_SKIP() << input << " is not there";
  const TemporaryFolder folder;
  const Outcome outcome = runProgram({"replay", input, "--output", folder.path("result"), "--drawings", "0"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  const auto summary = nlohmann::json::parse(fileContent(folder.path("result/summary.json")));
  EXPECT_LT(summary["absolute_trajectory_error"]["trajectory"]["rmse_m"].get<double>(), GetParam().error_m);
  EXPECT_GE(summary["coverage_from_first_pose"].get<double>(), 0.97);
  EXPECT_LE(summary["first_pose_s"].get<double>(), 3.0);

  // Positions are as uncertain as they say, and do not say so by being uncertain without need.
  const Honesty honesty =
      honestyOf(readMeasuredPoses(folder.path("result")), readTrajectory(input + "/groundtruth.txt"));
  EXPECT_GE(honesty.share_within, 0.99);
  EXPECT_GE(honesty.normalised_error, 0.005);
  EXPECT_LE(honesty.normalised_error, 2);
  if (!std::filesystem::exists(input + "/surfaces.txt")) return;
  const AbsoluteError error = absoluteError(readTrajectory(folder.path("result/trajectory.txt")),
                                            readTrajectory(input + "/groundtruth.txt"), Alignment::similarity);
  EXPECT_LT(medianDistanceToSurfaces(readMapPoints(folder.path("result/map.ply")), error.reference_T_estimate,
                                     readSurfaces(input + "/surfaces.txt")),
            0.03);
}

INSTANTIATE_TEST_SUITE_P(Data, SharedSequence,
                         ::testing::Values(Expected{"notex_far", 0.03}, Expected{"tex_near", 0.005},
                                           Expected{"xyz", 0.0035}),
                         [](const auto& sequence) { return sequence.param.sequence; });

}  // namespace
}  // namespace edgeslam
