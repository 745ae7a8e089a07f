// The daemon while its disk is full, read-only, broken, slow or gone: poses go on, it is told, and with the disk
// recording and saving come back.
#include <gtest/gtest.h>

#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "recording/recording_source.h"
#include "system/faults/faulty_daemon.h"

namespace edgeslam {
namespace {

struct DiskTrouble {
  Fault fault;
  std::string name, reason;
};

std::string nameOf(const testing::TestParamInfo<DiskTrouble>& trouble) { return trouble.param.name; }

class FailingDiskOfADaemon : public FaultyDaemon, public testing::WithParamInterface<DiskTrouble> {};

TEST_P(FailingDiskOfADaemon, CostsTheRecordingAndComesBack) {
  FaultPlan plan;
  plan.under = disk_;
  plan.fault = GetParam().fault;
  plan.while_exists = broken_;
  const auto daemon = startFaulty(
      plan, {"--config", configure("recording: {folder: " + recordings_ + ", from_start: true}\n"), "--map-out", map_});
  ASSERT_TRUE(isTracking()) << daemon->said();
  daemon->send(SIGHUP);
  ASSERT_TRUE(daemon->says("points saved to " + map_)) << daemon->said();
  const std::string saved = fileContent(map_);
  const std::string recording = std::filesystem::directory_iterator(recordings_)->path().string();
  ASSERT_TRUE(hasRecorded(recording, 10)) << daemon->said();

  folder_.write("broken", "");
  EXPECT_TRUE(daemon->says(GetParam().reason)) << daemon->said();
  EXPECT_TRUE(tellsRecording(false)) << daemon->said();
  daemon->send(SIGHUP);
  EXPECT_TRUE(daemon->says("the map is not saved: " + map_ + ": cannot be written: " + GetParam().reason))
      << daemon->said();
  EXPECT_TRUE(fileContent(map_) == saved) << "the map before stays";
  const command_answer_t refused = robot_->ask(command_t::START_RECORDING);
  EXPECT_FALSE(refused.accepted) << refused.message;
  EXPECT_TRUE(goesOn()) << daemon->said();
  EXPECT_EQ(daemon->times("recording to " + recording + " ended after "), 1) << "told once: " << daemon->said();

  std::filesystem::remove(broken_);
  const command_answer_t begun = robot_->ask(command_t::START_RECORDING);
  EXPECT_TRUE(begun.accepted) << begun.message;
  EXPECT_TRUE(tellsRecording(true)) << daemon->said();
  EXPECT_TRUE(goesOn()) << daemon->said();
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
  const Recording first = readRecording(recording);
  EXPECT_FALSE(first.decisions.complete);
  EXPECT_GE(first.frames.size(), 10U) << first.decisions.note;
  const Recording second = readRecording(begun.message.substr(begun.message.find('/')));
  EXPECT_FALSE(second.frames.empty());
  EXPECT_EQ(second.decisions.note.find("breaks off"), std::string::npos) << second.decisions.note;
}

INSTANTIATE_TEST_SUITE_P(Disk, FailingDiskOfADaemon,
                         testing::Values(DiskTrouble{Fault::no_space, "full", "No space left on device"},
                                         DiskTrouble{Fault::read_only, "read_only", "Read-only file system"},
                                         DiskTrouble{Fault::broken, "broken", "Input/output error"}),
                         nameOf);

class DiskOfADaemon : public FaultyDaemon {
 protected:
  std::unique_ptr<BackgroundProcess> startRecording(Fault fault) {
    FaultPlan plan;
    plan.under = disk_;
    plan.fault = fault;
    plan.while_exists = broken_;
    const std::string recording = "recording: {folder: " + recordings_ + ", from_start: true}\n";
    return startFaulty(plan, {"--config", configure(recording), "--map-out", map_});
  }
};

// 50 ms for each call that changes a file: a frame that is recorded takes at least three.
TEST_F(DiskOfADaemon, WhereSlowCostsFramesOfTheRecordingAndNoPoses) {
  const auto daemon = startRecording(Fault::slow);
  ASSERT_TRUE(isTracking()) << daemon->said();
  const std::string recording = std::filesystem::directory_iterator(recordings_)->path().string();
  ASSERT_TRUE(hasRecorded(recording, 10)) << daemon->said();
  folder_.write("broken", "");
  const Heard before = robot_->heard();
  ASSERT_TRUE(robot_->hears([&](const Heard& heard) { return heard.statuses.size() > before.statuses.size() + 4; }));
  // The recorder can write 6 frames a second. Of the others, which wait in the end, it writes those of three seconds.
  const Heard after = robot_->heard();
  const std::int64_t captured = after.statuses.back().frames_captured - before.statuses.back().frames_captured;
  const std::int64_t dropped = after.statuses.back().frames_dropped - before.statuses.back().frames_dropped;
  EXPECT_GT(captured, 80) << "the camera is not held up";
  EXPECT_LT(dropped, captured / 2) << "nor is tracking";
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  const Recording first = readRecording(recording);
  EXPECT_GT(first.decisions.not_recorded, 0) << "what was lost is told";
  EXPECT_TRUE(daemon->says("without " + std::to_string(first.decisions.not_recorded) + " frames or decisions"))
      << daemon->said();
  EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
}

// Commands that need it, too.
TEST_F(DiskOfADaemon, WhereStuckCostsNoPoses) {
  const auto daemon = startRecording(Fault::stuck);
  ASSERT_TRUE(isTracking()) << daemon->said();
  const std::string recording = std::filesystem::directory_iterator(recordings_)->path().string();
  ASSERT_TRUE(hasRecorded(recording, 10)) << daemon->said();

  folder_.write("broken", "");
  daemon->send(SIGHUP);
  EXPECT_TRUE(goesOn()) << daemon->said();
  const command_answer_t reset = robot_->ask(command_t::RESET);
  EXPECT_TRUE(reset.accepted) << reset.message;
  EXPECT_EQ(daemon->times("no recording: " + recordings_ + ": the disk does not answer"), 1) << daemon->said();
  EXPECT_EQ(daemon->times("begun anew"), 1) << "sent again, it is done once: " << daemon->said();
  EXPECT_TRUE(tellsRecording(false)) << daemon->said();
  const command_answer_t refused = robot_->ask(command_t::START_RECORDING);
  EXPECT_FALSE(refused.accepted);
  EXPECT_NE(refused.message.find("the disk does not answer"), std::string::npos) << refused.message;
  EXPECT_TRUE(goesOn()) << daemon->said();

  std::filesystem::remove(broken_);
  EXPECT_TRUE(daemon->says("recording to " + recording + " ended with the run")) << daemon->said();
  EXPECT_TRUE(daemon->says("points saved to " + map_)) << daemon->said();
  const command_answer_t begun = robot_->ask(command_t::START_RECORDING);
  EXPECT_TRUE(begun.accepted) << begun.message;
  EXPECT_TRUE(goesOn()) << daemon->said();
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_GE(readRecording(recording).frames.size(), 10U);
  EXPECT_FALSE(readRecording(begun.message.substr(begun.message.find('/'))).frames.empty());
  const std::filesystem::directory_iterator folders(recordings_);
  EXPECT_EQ(std::distance(begin(folders), end(folders)), 2) << "those that came too late are not there";
}

TEST_F(DiskOfADaemon, WhereStuckHoldsUpTheEndForSomeSecondsAndNotForEver) {
  const auto daemon = startRecording(Fault::stuck);
  ASSERT_TRUE(isTracking()) << daemon->said();
  const std::string recording = std::filesystem::directory_iterator(recordings_)->path().string();
  ASSERT_TRUE(hasRecorded(recording, 10)) << daemon->said();
  folder_.write("broken", "");
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 1) << daemon->said();
  EXPECT_EQ(daemon->times("the disk does not answer: ended all the same, and what it had not taken"), 1)
      << daemon->said();
  EXPECT_GE(readRecording(recording).frames.size(), 10U) << "what was confirmed is there";
  EXPECT_FALSE(std::filesystem::exists(map_));
}

// The thread that takes the signals opens the first recording.
TEST_F(DiskOfADaemon, WhereStuckAtTheStartLikewise) {
  FaultPlan plan;
  plan.under = disk_;
  plan.fault = Fault::stuck;
  const auto daemon = startFaulty(plan, {"--record", recordings_});
  ASSERT_TRUE(daemon->says("camera: ")) << daemon->said();
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 1) << daemon->said();
  EXPECT_TRUE(daemon->says("the disk does not answer: ended all the same")) << daemon->said();
}

TEST_F(DiskOfADaemon, WhereItsFoldersVanishIsToldAndPosesGoOn) {
  const auto daemon = startFaulty(FaultPlan(), {"--record", recordings_ + "/now", "--map-out", map_});
  ASSERT_TRUE(isTracking()) << daemon->said();
  std::filesystem::remove_all(disk_);
  EXPECT_TRUE(daemon->says("No such file or directory")) << daemon->said();
  daemon->send(SIGHUP);
  EXPECT_TRUE(daemon->says("the map is not saved: " + map_)) << daemon->said();
  EXPECT_TRUE(goesOn()) << daemon->said();
  EXPECT_TRUE(tellsRecording(false)) << daemon->said();
  std::filesystem::create_directory(disk_);
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
}

}  // namespace
}  // namespace edgeslam
