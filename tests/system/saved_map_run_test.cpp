// A map saved by one run is continued by another. The sequences are made by ctest (see CMakeLists.txt): `hall` and
// `parlour` have posters or furniture; `parlour_again` is the same room on another day, by another hand.
#include <gtest/gtest.h>
#include <unistd.h>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

const std::string run_folder = EDGESLAM_RUN_FOLDER;
const std::string hall = run_folder + "/hall", parlour = run_folder + "/parlour",
                  parlour_again = run_folder + "/parlour_again";

class SavedMapRun : public ::testing::Test {
 protected:
  // Frames `first` to `last` of a sequence, run with these options.
  ReplayedRun run(const std::string& sequence, int first, int last, const std::vector<std::string>& options,
                  double start_s = 1000) {
    const std::string name = "sequence" + std::to_string(++runs_);
    last_sequence_ = EditedSequence(start_s).add(sequence, first, last).write(folder_, name);
    return replayed(last_sequence_, folder_.path("result" + std::to_string(runs_)), options);
  }
  Trajectory truth() const { return readTrajectory(last_sequence_ + "/groundtruth.txt"); }
  std::string map(const std::string& name = "hall.map") const { return folder_.path(name); }

  // Exit code 2, one line that holds the text, no result.
  static void expectRefused(const ReplayedRun& refused, const std::string& path, const std::string& text) {
    EXPECT_EQ(refused.outcome.exit_code, 2);
    ASSERT_EQ(refused.outcome.failures().size(), 1U) << refused.outcome.messages;
    EXPECT_EQ(refused.outcome.failures()[0].rfind("edgeslam: " + path + ": ", 0), 0U) << refused.outcome.messages;
    EXPECT_NE(refused.outcome.failures()[0].find(text), std::string::npos) << refused.outcome.messages;
    EXPECT_FALSE(fs::exists(refused.folder)) << text;
  }

  const TemporaryFolder folder_;

 private:
  int runs_ = 0;
  std::string last_sequence_;
};

// With lines as landmarks (`lines.enabled`): the same bytes twice, a map that is larger by its lines, and is continued.
TEST_F(SavedMapRun, ItsLinesAreSavedAndContinued) {
  folder_.write("points.yaml", "lines: {enabled: false}\n");
  const ReplayedRun without =
      run(hall, 0, 149, {"--config", folder_.path("points.yaml"), "--map-out", map("points.map")});
  ASSERT_EQ(without.outcome.exit_code, 0) << without.outcome.messages;
  for (const char* name : {"hall.map", "again.map"}) {
    const ReplayedRun first = run(hall, 0, 149, {"--map-out", map(name)});
    ASSERT_EQ(first.outcome.exit_code, 0) << first.outcome.messages;
    EXPECT_LT(largestError(readTrajectory(first.folder + "/trajectory.txt"), truth()), 0.03);
  }
  EXPECT_EQ(fileContent(map("hall.map")), fileContent(map("again.map")));
  EXPECT_NE(fileContent(map("hall.map")), fileContent(map("points.map")));
  const ReplayedRun second = run(hall, 150, 299, {"--map-in", map()}, 2000);
  ASSERT_EQ(second.outcome.exit_code, 0) << second.outcome.messages;
  EXPECT_GE(second.firstGood(0), 0);
  EXPECT_LE(second.firstGood(0), 30) << "within a second";
  EXPECT_LT(largestError(readTrajectory(second.folder + "/trajectory.txt"), truth()), 0.03);
}

// One similarity takes the poses of both runs to the truth: the second run's are in the map's world. The first tenth of
// the second may be ahead of the map.
TEST_F(SavedMapRun, TheSecondHalfIsFoundInTheMapOfTheFirst) {
  for (const auto& [sequence, error_m] : {std::pair{hall, 0.012}, std::pair{parlour, 0.06}}) {
    SCOPED_TRACE(sequence);
    const ReplayedRun first = run(sequence, 0, 149, {"--map-out", map()});
    ASSERT_EQ(first.outcome.exit_code, 0) << first.outcome.messages;
    const Trajectory first_truth = truth();
    const ReplayedRun second = run(sequence, 150, 299, {"--map-in", map()}, 2000);
    ASSERT_EQ(second.outcome.exit_code, 0) << second.outcome.messages;
    const int found = second.firstGood(0);
    ASSERT_GE(found, 0);
    EXPECT_LE(found, 30) << "within a second";
    EXPECT_EQ(second.states[static_cast<std::size_t>(found)], "relocalised");
    EXPECT_EQ(second.count("lost", 0, 149), found) << "lost until it is found, never again";
    EXPECT_EQ(second.count("initialising", 0, 149), 0);
    EXPECT_GE(second.summary["relocalisations"].get<int>(), 1);
    EXPECT_EQ(second.summary["initialisation"], "a saved map");
    for (const char* poses : {"/trajectory.txt", "/trajectory_live.txt"}) {
      const Trajectory both = joined(readTrajectory(first.folder + poses), readTrajectory(second.folder + poses));
      EXPECT_LT(largestError(both, joined(first_truth, truth())), error_m) << poses;
    }
  }
}

// Another day: other tremor, other noise, and a clock that is set back.
TEST_F(SavedMapRun, AnotherRecordingOfThePlaceIsFoundInIt) {
  const ReplayedRun first = run(parlour, 0, 299, {"--map-out", map()}, 1.7e9);
  ASSERT_EQ(first.outcome.exit_code, 0) << first.outcome.messages;
  const Trajectory first_truth = truth();
  const ReplayedRun second = run(parlour_again, 60, 239, {"--map-in", map()}, 5);
  ASSERT_EQ(second.outcome.exit_code, 0) << second.outcome.messages;
  EXPECT_GE(second.firstGood(0), 0);
  EXPECT_LE(second.firstGood(0), 30);
  EXPECT_GE(second.summary["frames"]["with_live_pose"].get<int>(), 140);
  const Trajectory both =
      joined(readTrajectory(first.folder + "/trajectory.txt"), readTrajectory(second.folder + "/trajectory.txt"));
  EXPECT_LT(largestError(both, joined(first_truth, truth())), 0.06);
}

TEST_F(SavedMapRun, TheSameRunSavesTheSameBytes) {
  run(hall, 0, 99, {"--map-out", map("a.map")});
  run(hall, 0, 99, {"--map-out", map("b.map")});
  EXPECT_GT(fileContent(map("a.map")).size(), 100'000U);
  EXPECT_TRUE(fileContent(map("a.map")) == fileContent(map("b.map")));
  run(hall, 100, 159, {"--map-in", map("a.map"), "--map-out", map("c.map")});
  run(hall, 100, 159, {"--map-in", map("b.map"), "--map-out", map("d.map")});
  EXPECT_FALSE(fileContent(map("c.map")) == fileContent(map("a.map")));
  EXPECT_TRUE(fileContent(map("c.map")) == fileContent(map("d.map")));
}

// From a map of a few keyframes into what it doesn't know, and again from what became of it.
TEST_F(SavedMapRun, ASmallMapGrowsInItsOwnFile) {
  const ReplayedRun first = run(hall, 0, 30, {"--map-out", map()});
  ASSERT_EQ(first.outcome.exit_code, 0) << first.outcome.messages;
  ASSERT_LE(first.summary["keyframes"].get<int>(), 12);
  int points = first.summary["map_points"].get<int>();
  for (const int begin : {20, 60}) {
    const ReplayedRun next = run(hall, begin, begin + 59, {"--map-in", map(), "--map-out", map()});
    ASSERT_EQ(next.outcome.exit_code, 0) << next.outcome.messages;
    EXPECT_GT(next.summary["map_points"].get<int>(), points + 50);
    points = next.summary["map_points"].get<int>();
    EXPECT_GE(next.summary["frames"]["with_live_pose"].get<int>(), 50);
    EXPECT_LT(largestError(readTrajectory(next.folder + "/trajectory.txt"), truth()), 0.02);
  }
  EXPECT_EQ(run(hall, 100, 119, {"--map-in", map()}).outcome.exit_code, 0);
}

// Nothing is taken for a place of the map that is none, and the map stays as it was.
TEST_F(SavedMapRun, AnotherPlaceIsNotFoundInIt) {
  run(hall, 0, 149, {"--map-out", map()});
  folder_.write("one.yaml", "tracking: {new_map: false}\n");  // or a map of the other place is begun beside it
  const ReplayedRun other =
      run(parlour, 0, 149, {"--map-in", map(), "--map-out", map("after.map"), "--config", folder_.path("one.yaml")});
  EXPECT_EQ(other.outcome.exit_code, 1);
  EXPECT_EQ(other.count("lost", 0, 149), 150);
  EXPECT_NE(other.outcome.output.find("no pose"), std::string::npos) << other.outcome.output;
  EXPECT_TRUE(fileContent(map()) == fileContent(map("after.map")));
}

TEST_F(SavedMapRun, WhatIsNoMapOfThisCameraIsRefused) {
  run(hall, 0, 30, {"--map-out", map()});
  const std::string whole = fileContent(map());
  ASSERT_GT(whole.size(), 10'000U);
  const auto expectMapRefused = [&](const std::string& path, const std::string& text) {
    expectRefused(run(hall, 0, 30, {"--map-in", path}), path, text);
  };
  expectMapRefused(folder_.path("missing.map"), "no such file");
  expectMapRefused(folder_.path(), "no file");
  expectMapRefused(folder_.write("empty.map", ""), "cut off");
  expectMapRefused(folder_.write("notes.map", "a shopping list"), "not a map");
  expectMapRefused(folder_.write("cut.map", whole.substr(0, whole.size() - 1)), "cut off");
  expectMapRefused(folder_.write("half.map", whole.substr(0, whole.size() / 2)), "cut off");
  for (const std::size_t place : {std::size_t{40}, whole.size() / 3, whole.size() - 2}) {
    std::string flipped = whole;
    flipped[place] = static_cast<char>(flipped[place] ^ 4);
    expectMapRefused(folder_.write("flipped.map", flipped), "damaged");
  }
  if (geteuid() != 0) {
    fs::permissions(map(), fs::perms::none);
    expectMapRefused(map(), "cannot be read");
    fs::permissions(map(), fs::perms::owner_all);
  }
  const std::string sequence = EditedSequence().add(hall, 0, 30).write(folder_, "other_camera");
  std::string calibration = fileContent(sequence + "/camera.yaml");
  calibration.insert(calibration.find("fx: ") + 4, "1");
  folder_.write("other_camera/camera.yaml", calibration);
  expectRefused(replayed(sequence, folder_.path("refused"), {"--map-in", map()}), map(), "another calibration");
}

TEST_F(SavedMapRun, WhereNoMapCanBeSavedIsToldBeforeTheRun) {
  folder_.write("file", "a file stands here");
  for (const auto& [path, text] :
       {std::pair{folder_.path("none/hall.map"), "is no folder"},
        std::pair{folder_.path("file/hall.map"), "is no folder"}, std::pair{folder_.path(), "no file"},
        std::pair{std::string("/dev/full"), "no file"}, std::pair{std::string("/proc/hall.map"), "cannot be saved"}}) {
    expectRefused(run(hall, 0, 30, {"--map-out", path}), path, text);
  }
  for (const char* option : {"--map-in", "--map-out"}) {
    const ReplayedRun unnamed = run(hall, 0, 30, {option, ""});
    EXPECT_EQ(unnamed.outcome.exit_code, 2);
    EXPECT_NE(unnamed.outcome.messages.find(option), std::string::npos) << unnamed.outcome.messages;
  }
}

TEST_F(SavedMapRun, WhereNoMapCameToStandNoneIsSaved) {
  const ReplayedRun short_run = run(hall, 0, 4, {"--map-out", map()});
  EXPECT_EQ(short_run.outcome.exit_code, 1);
  ASSERT_EQ(short_run.outcome.failures().size(), 1U) << short_run.outcome.messages;
  EXPECT_NE(short_run.outcome.failures()[0].find("not written: no map came to stand"), std::string::npos);
  EXPECT_FALSE(fs::exists(map()));
}

// Where the disk fills up the run's results, which came first, stay, and so does the earlier map.
TEST_F(SavedMapRun, AFullDiskCostsTheNewMapAlone) {
  const ReplayedRun first = run(hall, 0, 149, {"--map-out", map()});
  const std::string earlier = fileContent(map());
  const std::size_t blocks = earlier.size() * 3 / 4 / 512;
  ASSERT_GT(blocks * 512, fs::file_size(first.folder + "/report.html"));
  const std::string sequence = EditedSequence().add(hall, 0, 149).write(folder_, "again");
  const Outcome full =
      runProgramAfter("trap '' XFSZ; ulimit -f " + std::to_string(blocks),
                      {"replay", sequence, "--output", folder_.path("kept"), "--drawings", "0", "--map-out", map()});
  EXPECT_EQ(full.exit_code, 2);
  ASSERT_EQ(full.failures().size(), 1U) << full.messages;
  EXPECT_NE(full.failures()[0].find(map() + ": cannot be written"), std::string::npos) << full.messages;
  EXPECT_TRUE(fs::exists(folder_.path("kept/summary.json")));
  EXPECT_TRUE(fileContent(map()) == earlier);
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename().string().find("hall.map."), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace edgeslam
