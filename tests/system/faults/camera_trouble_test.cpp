// The daemon on a camera that goes away, freezes, breaks its frames, repeats or reorders them, and is well again: it
// says what is wrong, poses are never told twice or backwards, and the same map is continued.
#include <gtest/gtest.h>

#include <set>

#include "frames/frame_source.h"
#include "recording/open_frame_source.h"
#include "recording/recording_source.h"
#include "system/daemon/daemon_fixture.h"
#include "system/faults/faulty_camera.h"
#include "system/faults/file_faults.h"
#include "system/program.h"
#include "unit/image_formats/made_jpeg.h"

namespace edgeslam {
namespace {

class CameraTrouble : public DaemonTest {
 protected:
  void SetUp() override {
    DaemonTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    useFrames([](const cv::Mat& grey) { return std::string(reinterpret_cast<const char*>(grey.data), grey.total()); });
  }
  // The first 150, as what `encode` makes of each.
  void useFrames(const std::function<std::string(const cv::Mat&)>& encode) {
    const auto source = openFrameSource(parlour_);
    std::string images;
    for (int i = 0; i < 150; ++i) {
      const std::optional<Frame> frame = source->next();
      ASSERT_TRUE(frame && frame->grey.size() == cv::Size(faulty_camera_width, faulty_camera_height));
      images += encode(frame->grey);
    }
    environment_ = {"env", faulty_camera_frames + ("=" + folder_.write("frames", images)),
                    faulty_camera_trouble + ("=" + trouble_)};
  }
  void startDaemon(const std::string& more = "") {
    const std::string configuration = configure("camera: {calibration: " + parlour_ + "/camera.yaml}\n" +
                                                "capture: {device: " + faulty_camera_device + "}\n" + more);
    Options command = environment_;
    for (const char* word : {"LD_PRELOAD=" EDGESLAM_FAULTY_CAMERA, EDGESLAM_PROGRAM, "run", "--config"}) {
      command.emplace_back(word);
    }
    command.push_back(configuration);
    daemon_ = std::make_unique<BackgroundProcess>(command);
    ASSERT_TRUE(isTracking()) << daemon_->said();
  }
  void TearDown() override {
    if (!daemon_) return;
    daemon_->send(SIGTERM);
    EXPECT_EQ(daemon_->exitCode(), 0) << daemon_->said();
    const std::vector<state_t> states = robot_->heard().states;
    bool has_map = false;
    for (std::size_t i = 1; i < states.size(); ++i) {
      ASSERT_GT(states[i].utime, states[i - 1].utime);
      ASSERT_GT(states[i].frame, states[i - 1].frame);
      has_map = has_map || isMeasured(states[i]);
      ASSERT_FALSE(has_map && states[i].state == state_t::INITIALISING) << "one map: " << daemon_->said();
    }
  }

  void begin(const std::string& trouble) const {
    // Whole at once, as the camera looks at every frame.
    std::filesystem::rename(folder_.write("trouble to come", trouble), trouble_);
  }
  void endAndTrack() const {
    std::filesystem::remove(trouble_);
    const std::size_t before = robot_->heard().states.size();
    EXPECT_TRUE(robot_->hears([&](const Heard& heard) {
      return heard.states.size() > before + 5 && isMeasured(heard.states.back());
    })) << daemon_->said();
    EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.state != state_t::LOST; }));
  }
  bool statusTells(const std::string& reason) const {
    return robot_->hearsStatus([&](const status_t& status) {
      return status.state == state_t::LOST && status.reason.find(reason) != std::string::npos;
    });
  }
  bool goesOn(std::size_t frames) const {
    const std::size_t before = robot_->heard().states.size();
    return robot_->hears([&](const Heard& heard) { return heard.states.size() > before + frames; });
  }
  // While the trouble lasts.
  bool dropsFrames(std::int64_t frames) const {
    const std::int64_t before = robot_->heard().statuses.back().frames_dropped;
    return robot_->hearsStatus([&](const status_t& status) { return status.frames_dropped >= before + frames; });
  }

  const std::string trouble_ = folder_.path("trouble");
  Options environment_;
  std::unique_ptr<BackgroundProcess> daemon_;
};

TEST_F(CameraTrouble, ThatLeavesNoFramesIsToldAndTheMapIsGoneOnWith) {
  ASSERT_NO_FATAL_FAILURE(startDaemon());
  const std::vector<std::pair<std::string, std::string>> troubles{
      {"gone", "(the camera is not plugged in)"},
      {"frozen", "the stream is frozen, no frame came in time"},
      {"size", "is refused, the camera would give 160 x 120"},
      {"short", "only damaged frames came: frame "},
      {"past", "only damaged frames came: its time stamp is not after that of the frame before"}};
  for (const auto& [trouble, reason] : troubles) {
    SCOPED_TRACE(trouble);
    begin(trouble);
    EXPECT_TRUE(statusTells(reason)) << robot_->heard().statuses.back().reason << "\n" << daemon_->said();
    EXPECT_NE(daemon_->said().find(reason), std::string::npos) << daemon_->said();
    endAndTrack();
  }
  EXPECT_LT(daemon_->times("\n"), 60) << "no flood: " << daemon_->said();
}

TEST_F(CameraTrouble, ThatLeavesSomeFramesCostsOnlyTheOthers) {
  ASSERT_NO_FATAL_FAILURE(startDaemon());
  for (const char* trouble : {"twice", "swapped", "bursts"}) {
    SCOPED_TRACE(trouble);
    begin(trouble);
    EXPECT_TRUE(dropsFrames(10)) << daemon_->said();
    EXPECT_TRUE(goesOn(10)) << daemon_->said();
    EXPECT_TRUE(robot_->heard().statuses.back().reason.find(faulty_camera_device) == std::string::npos)
        << robot_->heard().statuses.back().reason;
    endAndTrack();
  }
}

// What it sees stands still, and so do the poses; the map does not grow meanwhile.
TEST_F(CameraTrouble, TheSameImageAgainAndAgainIsACameraThatStandsStill) {
  ASSERT_NO_FATAL_FAILURE(startDaemon());
  ASSERT_TRUE(goesOn(60));
  begin("repeated");
  ASSERT_TRUE(goesOn(20));
  const Heard before = robot_->heard();
  const int keyframes = before.statuses.back().keyframes;
  ASSERT_TRUE(goesOn(60));
  const Heard after = robot_->heard();
  const Trajectory all = trajectoryOf(before.states);
  const std::vector<state_t> meanwhile(after.states.begin() + static_cast<std::ptrdiff_t>(before.states.size()),
                                       after.states.end());
  double way = 0;
  for (const StampedPose& pose : all) {
    way = std::max(way, (pose.world_T_camera.translation - all.front().world_T_camera.translation).norm());
  }
  const Trajectory standing = trajectoryOf(meanwhile);
  for (const StampedPose& pose : standing) {
    EXPECT_LT((pose.world_T_camera.translation - standing.front().world_T_camera.translation).norm(), 0.02 * way);
  }
  EXPECT_LE(after.statuses.back().keyframes, keyframes + 2);
  endAndTrack();
}

// No trouble: it is recorded to the last byte, and packed no more.
TEST_F(CameraTrouble, AMotionJpegCameraIsRecordedAsItCameAndTheRunIsRepeated) {
  std::set<std::string> sent;
  ASSERT_NO_FATAL_FAILURE(useFrames([&](const cv::Mat& grey) {
    const std::vector<unsigned char> jpeg = madeJpeg(grey);
    return *sent.emplace(jpeg.begin(), jpeg.end()).first;
  }));
  const std::string recordings = folder_.path("recordings");
  ASSERT_NO_FATAL_FAILURE(startDaemon("recording: {folder: " + recordings + ", from_start: true}\n"));
  ASSERT_TRUE(goesOn(40));
  daemon_->send(SIGTERM);
  ASSERT_EQ(daemon_->exitCode(), 0) << daemon_->said();
  daemon_.reset();

  const std::string path = std::filesystem::directory_iterator(recordings)->path().string();
  const Recording recording = readRecording(path);
  EXPECT_TRUE(recording.decisions.complete) << recording.decisions.note;
  ASSERT_GT(recording.frames.size(), 40U);
  for (const RecordedFrame& frame : recording.frames) {
    EXPECT_EQ(sent.count(readArchivedImage(path + "/rgb.tar", *frame.image).bytes), 1U) << frame.index;
  }
  expectRepeats(path);
}

// `edgeslam record` asks the disk for all it has once a second (syncfs): in the thread that writes, so that frames
// still come, and are counted where there is no more room for them.
TEST_F(CameraTrouble, ADiskThatHangsCostsARecordingFramesThatAreCounted) {
  FaultPlan plan;
  plan.under = folder_.path("disk");
  plan.fault = Fault::stuck;
  plan.while_exists = folder_.path("stuck");
  std::filesystem::create_directory(plan.under);
  const std::string recording = plan.under + "/recording";
  Options command = environment_;
  for (const std::string& variable : faultEnvironment(EDGESLAM_FILE_FAULTS ":" EDGESLAM_FAULTY_CAMERA, plan)) {
    command.push_back(variable);
  }
  for (const char* word : {EDGESLAM_PROGRAM, "record", faulty_camera_device, "--keep-free", "0"}) {
    command.emplace_back(word);
  }
  command.insert(command.end(), {"--calibration", parlour_ + "/camera.yaml", "--output", recording});
  BackgroundProcess record(command);
  ASSERT_TRUE(comesTrue([&] { return runsWell("ls " + recording + "/rgb/*.png"); })) << record.said();
  folder_.write("stuck", "");
  std::this_thread::sleep_for(std::chrono::seconds(6));  // 180 frames; there is room for 90
  record.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  std::filesystem::remove(plan.while_exists);
  EXPECT_EQ(record.exitCode(), 0) << record.said();
  EXPECT_NE(record.said().find("lost as the disk was too slow"), std::string::npos) << record.said();
  const auto source = openFrameSource(recording);
  EXPECT_GE(source->size(), 90);
  for (std::optional<Frame> frame = source->next(); frame; frame = source->next()) EXPECT_EQ(frame->problem, "");
}

}  // namespace
}  // namespace edgeslam
