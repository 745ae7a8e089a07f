// The frame that never jumps, over whole runs: steps from frame to frame are like their neighbours, through keyframes,
// corrections of the map and blurred frames. The sequences are made by ctest (see CMakeLists.txt).
#include <gtest/gtest.h>

#include "geometry/median.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

struct Expected {
  std::string sequence;
  double error_m;  // over the whole way
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.sequence; }

class Odometry : public ::testing::TestWithParam<Expected> {};

std::vector<double> stepsOf(const Trajectory& trajectory) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back((trajectory[i].world_T_camera.translation - trajectory[i - 1].world_T_camera.translation).norm());
  }
  return steps;
}

double medianAround(const std::vector<double>& steps, std::size_t place) {
  constexpr std::size_t reach = 5;
  const std::size_t first = place - std::min(place, reach), last = std::min(steps.size() - 1, place + reach);
  return upperMedian(std::vector<double>(steps.begin() + static_cast<std::ptrdiff_t>(first),
                                         steps.begin() + static_cast<std::ptrdiff_t>(last) + 1));
}

TEST_P(Odometry, DoesNotJump) {
  const std::string sequence = std::string(EDGESLAM_RUN_FOLDER) + "/" + GetParam().sequence;
  const TemporaryFolder folder;
  const ReplayedRun run = replayed(sequence, folder.path("result"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.messages;
  const Trajectory odometry = readTrajectory(run.folder + "/trajectory_odometry.txt");
  const int first = run.firstGood(0);
  ASSERT_GE(first, 0);
  EXPECT_EQ(odometry.size(), run.states.size() - static_cast<std::size_t>(first)) << "every frame has one";
  const std::vector<double> steps = stepsOf(odometry);
  const double usual = upperMedian(std::vector<double>(steps));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    // Where the camera nearly stands, steps are noise: they are held against the usual one.
    EXPECT_LT(steps[i], 3 * std::max(medianAround(steps, i), 0.5 * usual)) << "at step " << i;
  }
  EXPECT_LT(largestError(odometry, readTrajectory(sequence + "/groundtruth.txt")), GetParam().error_m);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Odometry,
                         ::testing::Values(Expected{"hall", 0.05}, Expected{"parlour", 0.08},
                                           Expected{"hall_shaken", 0.15}, Expected{"tiles", 0.3}),
                         [](const auto& scene) { return scene.param.sequence; });

}  // namespace
}  // namespace edgeslam
