// Localisation only (`map.frozen`): a saved map is read, poses come from it, and it stays as it is. The sequences are
// made by ctest (see CMakeLists.txt).
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

const std::string run_folder = EDGESLAM_RUN_FOLDER;
const std::string hall = run_folder + "/hall", parlour = run_folder + "/parlour",
                  parlour_again = run_folder + "/parlour_again";

class FrozenMap : public ::testing::Test {
 protected:
  void SetUp() override { frozen_ = folder_.write("frozen.yaml", "map: {frozen: true}\n"); }

  ReplayedRun run(const EditedSequence& edited, const std::vector<std::string>& options) {
    const std::string name = "sequence" + std::to_string(++runs_);
    last_sequence_ = edited.write(folder_, name);
    return replayed(last_sequence_, folder_.path("result" + std::to_string(runs_)), options);
  }
  Trajectory truth() const { return readTrajectory(last_sequence_ + "/groundtruth.txt"); }
  // Its poses and the truth's.
  std::pair<Trajectory, Trajectory> mapped(const std::string& sequence, int first, int last) {
    const ReplayedRun made = run(EditedSequence(1000).add(sequence, first, last), {"--map-out", map()});
    EXPECT_EQ(made.outcome.exit_code, 0) << made.outcome.messages;
    return {readTrajectory(made.folder + "/trajectory.txt"), truth()};
  }
  std::string map(const std::string& name = "place.map") const { return folder_.path(name); }

  const TemporaryFolder folder_;
  std::string frozen_;

 private:
  int runs_ = 0;
  std::string last_sequence_;
};

// Another day, another hand: errors near the first run's, in its frame; and the map's bytes are the same.
TEST_F(FrozenMap, AnotherRunIsLocalisedInItAndNothingIsChanged) {
  const auto [first, first_truth] = mapped(parlour, 0, 299);
  const ReplayedRun second = run(EditedSequence(5000).add(parlour_again, 30, 269),
                                 {"--map-in", map(), "--map-out", map("after.map"), "--config", frozen_});
  ASSERT_EQ(second.outcome.exit_code, 0) << second.outcome.messages;
  EXPECT_TRUE(fileContent(map()) == fileContent(map("after.map")));
  EXPECT_EQ(second.summary["keyframes"], 0) << "of this run";
  const int found = second.firstGood(0);
  ASSERT_GE(found, 0);
  EXPECT_LE(found, 30);
  EXPECT_GE(second.countGood(found, 239), 225 - found);
  EXPECT_EQ(second.count("initialising", 0, 239) + second.count("recovered", 0, 239), 0);
  for (const int world : second.worlds) EXPECT_LE(world, 0) << "no other map is begun";
  const Trajectory both = joined(first, readTrajectory(second.folder + "/trajectory_live.txt"));
  EXPECT_LT(largestError(both, joined(first_truth, truth())), 0.06);
}

TEST_F(FrozenMap, TheSameRunGivesTheSameBytes) {
  mapped(hall, 0, 149);
  std::vector<std::string> poses;
  for (int again = 0; again < 2; ++again) {
    const ReplayedRun frozen = run(EditedSequence(2000).add(hall, 149, 0), {"--map-in", map(), "--config", frozen_});
    ASSERT_EQ(frozen.outcome.exit_code, 0) << frozen.outcome.messages;
    poses.push_back(fileContent(frozen.folder + "/trajectory_live.txt"));
  }
  EXPECT_GT(poses[0].size(), 1000U);
  EXPECT_TRUE(poses[0] == poses[1]);
}

// Into what the map has not, and back: predicted, then lost, with its reason, and found again.
TEST_F(FrozenMap, WhereTheMapDoesNotShowPosesArePredictedAndSaidToBe) {
  mapped(hall, 0, 149);
  const ReplayedRun away = run(EditedSequence(2000).add(hall, 0, 99).add(parlour, 0, 89).add(hall, 99, 40),
                               {"--map-in", map(), "--map-out", map("after.map"), "--config", frozen_});
  ASSERT_EQ(away.outcome.exit_code, 0) << away.outcome.messages;
  EXPECT_GE(away.countGood(0, 99), 70);
  EXPECT_EQ(away.countGood(100, 189), 0) << "another room";
  EXPECT_GE(away.count("predicted", 100, 189), 20);
  EXPECT_GE(away.count("lost", 150, 189), 30);
  EXPECT_GE(away.countGood(190, 249), 30) << "found again";
  EXPECT_LT(largestError(readTrajectory(away.folder + "/trajectory_live.txt"), truth()), 0.03);
  EXPECT_TRUE(fileContent(map()) == fileContent(map("after.map")));
}

// The shares of mapping in a frame's time, of a run that maps on and of one that does not. A share hardly hangs on how
// fast the machine is.
TEST_F(FrozenMap, MappingCostsNextToNothing) {
  mapped(parlour, 0, 299);
  std::vector<double> shares;
  for (const bool frozen : {false, true}) {
    std::vector<std::string> options{"--map-in", map()};
    if (frozen) options.insert(options.end(), {"--config", frozen_});
    const ReplayedRun second = run(EditedSequence(5000).add(parlour_again, 60, 239), options);
    ASSERT_EQ(second.outcome.exit_code, 0) << second.outcome.messages;
    const nlohmann::json& stages = second.summary["stage_times_ms"];
    shares.push_back(stages["mapping"]["mean"].get<double>() / stages["total"]["mean"].get<double>());
  }
  RecordProperty("share_of_mapping", std::to_string(shares[0]));
  RecordProperty("share_of_mapping_frozen", std::to_string(shares[1]));
  EXPECT_LT(shares[1], 0.5 * shares[0]);
}

TEST_F(FrozenMap, MemoryStaysTheSameForAnyTime) {
  mapped(hall, 0, 149);
  std::vector<long> peaks;
  for (const int frames : {300, 1200}) {
    EditedSequence walk(2000);
    while (walk.size() < frames) walk.add(hall, 0, 149).add(hall, 148, 1);
    const ReplayedRun frozen = run(walk, {"--map-in", map(), "--config", frozen_});
    ASSERT_EQ(frozen.outcome.exit_code, 0) << frozen.outcome.messages;
    EXPECT_GE(frozen.countGood(0, walk.size() - 1), walk.size() - 20);
    peaks.push_back(frozen.outcome.peak_memory_kb);
  }
  EXPECT_LT(static_cast<double>(peaks[1]), 1.1 * static_cast<double>(peaks[0]));
}

TEST_F(FrozenMap, WithoutAMapItIsRefused) {
  const std::string sequence = EditedSequence(1000).add(hall, 0, 10).write(folder_, "short");
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"replay", sequence, "--output", folder_.path("none"), "--config", frozen_},
        {"replay", sequence, "--output", folder_.path("none"), "--config", frozen_, "--realtime"},
        {"run", "--source", sequence, "--config", frozen_},
        {"view", sequence, "--config", frozen_, "--port", "0"}}) {
    const Outcome refused = runProgram(options);
    EXPECT_EQ(refused.exit_code, 2) << options[0];
    ASSERT_EQ(refused.failures().size(), 1U) << refused.messages;
    EXPECT_NE(refused.failures()[0].find("map.frozen: there is no map to localise in; give one ("), std::string::npos)
        << refused.messages;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path("none")));
  const std::string nowhere = folder_.write("nowhere.yaml", "map: {frozen: true, file: " + map("missing.map") + "}\n");
  const Outcome missing = runProgram({"run", "--source", sequence, "--config", nowhere});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.messages.find("missing.map: no such file"), std::string::npos) << missing.messages;
}

// A map that a frozen run cannot use stays where it is, as it is.
TEST_F(FrozenMap, AFileThatIsNoMapIsRefusedAndLeftAlone) {
  const std::string sequence = EditedSequence(1000).add(hall, 0, 10).write(folder_, "short");
  const std::string file = folder_.write("broken.map", "no map");
  const std::string configuration = folder_.write("robot.yaml", "map: {frozen: true, file: " + file + "}\n");
  const Outcome refused = runProgram({"run", "--source", sequence, "--config", configuration});
  EXPECT_EQ(refused.exit_code, 2);
  ASSERT_EQ(refused.failures().size(), 1U) << refused.messages;
  EXPECT_NE(refused.failures()[0].find(file + ": is not a map saved by edgeslam"), std::string::npos);
  EXPECT_EQ(fileContent(file), "no map");
  EXPECT_FALSE(std::filesystem::exists(file + ".refused"));
}

// A recording of a frozen run repeats it: it brings its map, and its configuration.
TEST_F(FrozenMap, ARecordingRepeatsTheRun) {
  mapped(hall, 0, 149);
  const std::string recording = folder_.path("recording");
  const ReplayedRun live = run(EditedSequence(2000).add(hall, 149, 30),
                               {"--map-in", map(), "--config", frozen_, "--realtime", "--record", recording});
  ASSERT_EQ(live.outcome.exit_code, 0) << live.outcome.messages;
  const ReplayedRun again = replayed(recording, folder_.path("again"));
  ASSERT_EQ(again.outcome.exit_code, 0) << again.outcome.messages;
  EXPECT_TRUE(fileContent(live.folder + "/trajectory_live.txt") == fileContent(again.folder + "/trajectory_live.txt"));
  EXPECT_EQ(again.summary["keyframes"], 0);
}

}  // namespace
}  // namespace edgeslam
