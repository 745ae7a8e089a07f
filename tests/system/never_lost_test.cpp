// What happens to a camera on a robot: something before the lens, a violent motion, frames that don't come, the way
// back. A pose that is said to be good is good, what is none is said to be none, and the camera is found again soon.
// The sequences are made by ctest (see CMakeLists.txt); by hand: `ctest -R NeverLost`.
#include <gtest/gtest.h>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

// Bounds are two to three times what was measured over the cases below; the cameras go along 2 to 3 m, some 2 m from
// the walls.
struct Place {
  std::string name;
  double error_m;       // largest of any pose in the end
  double live_error_m;  // largest of any pose said to be good at the time, before drift was taken out
};

const Place hall{"hall", 0.012, 0.02}, parlour{"parlour", 0.05, 0.06}, bare{"bare", 0.06, 0.12};

void PrintTo(const Place& place, std::ostream* out) { *out << place.name; }

std::string folderOf(const std::string& name) { return std::string(EDGESLAM_RUN_FOLDER) + "/" + name; }

class NeverLost : public ::testing::TestWithParam<Place> {
 protected:
  static std::string frames() { return folderOf(GetParam().name); }

  ReplayedRun run(const EditedSequence& edited) {
    const std::string sequence = edited.write(folder_, "sequence" + std::to_string(++runs_));
    ReplayedRun result = replayed(sequence, folder_.path("result" + std::to_string(runs_)));
    EXPECT_EQ(result.outcome.exit_code, 0) << result.outcome.messages;
    EXPECT_EQ(static_cast<int>(result.states.size()), edited.size());
    const Trajectory truth = readTrajectory(sequence + "/groundtruth.txt");
    EXPECT_LT(largestError(readTrajectory(result.folder + "/trajectory_live.txt"), truth), GetParam().live_error_m);
    EXPECT_LT(largestError(readTrajectory(result.folder + "/trajectory.txt"), truth), GetParam().error_m);
    return result;
  }

  // Within so many frames from `first` on there is a pose again, and nearly all after it have one.
  static void expectFoundWithin(const ReplayedRun& result, int first, int frames) {
    const int found = result.firstGood(first), last = static_cast<int>(result.states.size()) - 1;
    ASSERT_GE(found, 0) << "never found again";
    EXPECT_LE(found - first, frames);
    EXPECT_LE(last - found + 1 - result.countGood(found, last), 3);
    for (int frame = found; frame <= last; ++frame) {
      EXPECT_LE(result.worlds[static_cast<std::size_t>(frame)], 0) << frame;
    }
  }
  // No pose is said to be measured between these frames.
  static void expectNoGoodPose(const ReplayedRun& result, int first, int last) {
    EXPECT_EQ(result.countGood(first, last), 0);
  }

 private:
  const TemporaryFolder folder_;
  int runs_ = 0;
};

// Half a second of it is bridged, after two seconds the camera is looked for in the map.
TEST_P(NeverLost, BlackFramesWhileTheCameraStands) {
  for (const int black : {15, 60}) {
    SCOPED_TRACE(black);
    const ReplayedRun result = run(EditedSequence().add(frames(), 0, 150).addBlack(black).add(frames(), 151, 190));
    expectNoGoodPose(result, 151, 150 + black);
    expectFoundWithin(result, 151 + black, 6);
  }
}

TEST_P(NeverLost, BlackFramesWhileTheCameraGoesOn) {
  const ReplayedRun result = run(EditedSequence().add(frames(), 0, 150).addBlack(15).add(frames(), 166, 200));
  expectNoGoodPose(result, 151, 165);
  expectFoundWithin(result, 166, 6);
}

TEST_P(NeverLost, HalfASecondWithoutFrames) {
  const ReplayedRun result = run(EditedSequence().add(frames(), 0, 150).wait(0.5).add(frames(), 166, 200));
  expectFoundWithin(result, 151, 15);
}

// What was seen on the way there is known on the way back, from the other side.
TEST_P(NeverLost, BackTheOtherWayAfterASecondInTheDark) {
  const ReplayedRun result = run(EditedSequence().add(frames(), 0, 150).addBlack(30).add(frames(), 100, 40));
  expectNoGoodPose(result, 151, 180);
  expectFoundWithin(result, 181, 15);
}

// As if it had been carried away: a second later the camera is somewhere else that it knows.
TEST_P(NeverLost, ElsewhereAfterASecond) {
  const ReplayedRun result = run(EditedSequence().add(frames(), 0, 150).wait(1).add(frames(), 60, 10));
  expectFoundWithin(result, 151, 30);
}

INSTANTIATE_TEST_SUITE_P(Places, NeverLost, ::testing::Values(hall, parlour, bare),
                         [](const auto& place) { return place.param.name; });

class FurnishedPlace : public NeverLost {};

// Frames 120 to 131 of the sequence are shaken.
TEST_P(FurnishedPlace, IsFoundAgainAfterAShake) {
  const ReplayedRun result = run(EditedSequence().add(folderOf(GetParam().name + "_shaken"), 0, 179));
  expectFoundWithin(result, 132, 15);
}

// What is before the lens afterwards was seen before, but not of late.
TEST_P(FurnishedPlace, IsFoundAgainAfterTwoSecondsInTheDark) {
  const ReplayedRun result = run(EditedSequence().add(frames(), 0, 150).addBlack(60).add(frames(), 211, 260));
  expectNoGoodPose(result, 151, 210);
  expectFoundWithin(result, 211, 15);
}

INSTANTIATE_TEST_SUITE_P(Places, FurnishedPlace, ::testing::Values(hall, parlour),
                         [](const auto& place) { return place.param.name; });

// A sensor that amplifies: bare walls, and what edges there are, of noise. The scale is not lost at the turns.
TEST(DimCorridor, IsFollowedAtItsScale) {
  const TemporaryFolder folder;
  const std::string sequence = folderOf("dim_corridor");
  const ReplayedRun result = replayed(sequence, folder.path("result"));
  ASSERT_EQ(result.outcome.exit_code, 0) << result.outcome.messages;
  const Trajectory truth = readTrajectory(sequence + "/groundtruth.txt");
  EXPECT_LT(largestError(readTrajectory(result.folder + "/trajectory.txt"), truth), 0.07);
  EXPECT_LT(largestError(readTrajectory(result.folder + "/trajectory_live.txt"), truth), 0.07);
  const int last = static_cast<int>(result.states.size()) - 1;
  EXPECT_LE(result.count("lost", 0, last) + result.count("predicted", 0, last), 3);
}

// A turn on the spot by 137 degrees and back, in 3.3 s: hardly anything on the way has a depth. Orientation goes on,
// the map grows on in the same world, and what was mapped before is known again afterwards.
TEST(Pan, IsFollowedByItsOrientation) {
  const TemporaryFolder folder;
  const std::string sequence = folderOf("parlour_pan");
  constexpr int pan = 150, after = 250;
  const std::string off = folder.write("off.yaml", "orientation_only: {enabled: false}\n");
  const ReplayedRun result = replayed(sequence, folder.path("result"));
  const ReplayedRun without = replayed(sequence, folder.path("without"), {"--config", off});
  ASSERT_EQ(result.outcome.exit_code, 0) << result.outcome.messages;
  ASSERT_EQ(without.outcome.exit_code, 0) << without.outcome.messages;
  EXPECT_GE(result.countGood(pan, after - 1), 80);
  EXPECT_LE(without.countGood(pan, after - 1), 60);
  const int last = static_cast<int>(result.states.size()) - 1;
  EXPECT_EQ(result.countGood(after, last), last - after + 1);
  for (const int world : result.worlds) EXPECT_LE(world, 0);

  const Trajectory truth = readTrajectory(sequence + "/groundtruth.txt");
  const Trajectory final = readTrajectory(result.folder + "/trajectory.txt");
  EXPECT_LT(largestError(final, truth), 0.3) << "a tenth of the distance";
  const Trajectory since(final.end() - (last - after), final.end());
  EXPECT_LT(largestError(since, truth), 0.03);
}

// Two places filmed one after the other, as if they were one: no loop joins them, and in the second no frame is taken
// for one of the first, but a world is begun.
class TwoPlaces : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(TwoPlaces, AreNotJoined) {
  const TemporaryFolder folder;
  const auto& [first, second] = GetParam();
  const std::string sequence =
      EditedSequence().add(folderOf(first), 0, 239).add(folderOf(second), 0, 59).write(folder, "sequence");
  const ReplayedRun result = replayed(sequence, folder.path("result"));
  ASSERT_EQ(result.outcome.exit_code, 0) << result.outcome.messages;
  EXPECT_GE(result.firstGood(0), 0);
  for (int frame = 240; frame < 300; ++frame) {
    if (result.countGood(frame, frame) == 0) continue;
    EXPECT_NE(result.worlds[static_cast<std::size_t>(frame)], 0) << frame << ": of another place";
  }
  for (const auto& loop : result.summary["closed_loops"]) EXPECT_LT(loop["frame"].get<int>(), 240) << loop;
}

INSTANTIATE_TEST_SUITE_P(Pairs, TwoPlaces,
                         ::testing::Values(std::pair{"bare", "parlour"}, std::pair{"parlour", "bare"},
                                           std::pair{"hall", "parlour"}),
                         [](const auto& pair) { return pair.param.first + "_" + pair.param.second; });

}  // namespace
}  // namespace edgeslam
