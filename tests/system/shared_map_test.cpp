// Sequences that are kept beside the source folder, where they are: a second run is found in the map of the first.
#include <gtest/gtest.h>

#include "system/run_result.h"

namespace edgeslam {
namespace {

struct Expected {
  std::string sequence;
  double error_m;  // largest of any pose of either run, after one similarity alignment
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.sequence; }

class SharedMap : public ::testing::TestWithParam<Expected> {};

Trajectory later(Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.time_ns += 1'000'000'000'000;
  return trajectory;
}

TEST_P(SharedMap, ASecondRunIsFoundInTheMapOfTheFirst) {
  const std::string input = std::string(EDGESLAM_SOURCE_DIR) + "/../shared/data/" + GetParam().sequence;
  if (!std::filesystem::exists(input)) GTEST_SKIP() << input << " is not there";
  const TemporaryFolder folder;
  const std::string map = folder.path("place.map");
  const ReplayedRun first = replayed(input, folder.path("first"), {"--map-out", map});
  const ReplayedRun second = replayed(input, folder.path("second"), {"--map-in", map});
  for (const ReplayedRun* run : {&first, &second}) ASSERT_EQ(run->outcome.exit_code, 0) << run->outcome.messages;
  const int found = second.firstGood(0), last = static_cast<int>(second.states.size()) - 1;
  ASSERT_GE(found, 0);
  EXPECT_LE(found, 30) << "within a second";
  EXPECT_EQ(second.states[static_cast<std::size_t>(found)], "relocalised");
  EXPECT_EQ(second.count("initialising", 0, last), 0);
  EXPECT_LE(second.count("lost", found, last), 5);
  const Trajectory truth = readTrajectory(input + "/groundtruth.txt");
  const Trajectory both = joined(readTrajectory(first.folder + "/trajectory.txt"),
                                 later(readTrajectory(second.folder + "/trajectory.txt")));
  EXPECT_LT(absoluteError(both, joined(truth, later(truth)), Alignment::similarity).translation.max,
            GetParam().error_m);
}

INSTANTIATE_TEST_SUITE_P(Data, SharedMap, ::testing::Values(Expected{"notex_far", 0.015}, Expected{"tex_near", 0.008}),
                         [](const auto& sequence) { return sequence.param.sequence; });

}  // namespace
}  // namespace edgeslam
