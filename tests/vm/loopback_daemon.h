// `edgeslam run` on a v4l2loopback camera into which a test feeds a recording, and a robot that listens.
#pragma once

#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>

#include "evaluation/evaluation.h"
#include "frames/frame_source.h"
#include "recording/open_frame_source.h"
#include "system/daemon/robot.h"
#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"
#include "vm/loopback_feeder.h"

namespace edgeslam {

// Everything is slower in an emulated machine that shares its processors with others.
constexpr double patience_s = 180;

inline std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

// Little work: the processors are emulated.
constexpr const char* little_work =
    "points: {count: 150}\n"
    "bundle: {iterations: 3}\n"
    "adjustment: {free_keyframes: 4, fixed_keyframes: 6}\n"
    "initialisation: {frames_between: 4, attempt_interval: 10}\n"
    "keyframes: {interval_s: 2}\n";

// A recording with ground truth, in memory.
struct FedSequence {
  std::string folder;
  std::vector<cv::Mat> frames;
  std::vector<std::int64_t> times_ns;
  double frames_per_second = 0;  // at which it is fed
};

inline FedSequence readFedSequence(const std::string& folder, double frames_per_second, std::size_t most_frames) {
  FedSequence sequence{folder, {}, {}, frames_per_second};
  const auto source = openFrameSource(folder);
  while (sequence.frames.size() < most_frames) {
    const std::optional<Frame> frame = source->next();
    if (!frame) break;
    sequence.frames.push_back(frame->grey.clone());
    sequence.times_ns.push_back(frame->time_ns);
  }
  return sequence;
}

class LoopbackDaemon : public OwnNetwork {
 protected:
  void SetUp() override {
    OwnNetwork::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (device_.empty()) GTEST_SKIP() << "no v4l2loopback here";
    robot_ = std::make_unique<Robot>();
  }

  std::unique_ptr<LoopbackFeeder> feed(const FedSequence& sequence, FeedingOrder order) const {
    return std::make_unique<LoopbackFeeder>(device_, sequence.frames, sequence.frames_per_second, order);
  }
  std::unique_ptr<BackgroundProcess> start(const FedSequence& sequence, std::vector<std::string> options = {}) {
    const std::string configuration =
        folder_.write("robot.yaml", "camera: {calibration: " + sequence.folder + "/camera.yaml}\n" +
                                        "capture: {device: " + device_ + "}\n" + little_work);
    options.insert(options.begin(), {EDGESLAM_PROGRAM, "run", "--config", configuration});
    return std::make_unique<BackgroundProcess>(options);
  }
  bool hears(const std::function<bool(const Heard&)>& what) const {
    return comesTrue([&] { return what(robot_->heard()); }, patience_s);
  }
  bool tracks() const {
    return hears([](const Heard& heard) { return !heard.states.empty() && isMeasured(heard.states.back()); });
  }

  // RMSE [m] after similarity alignment of the measured poses of the frames whose place among those fed is known
  // (`fed`, by state_t.frame), with the poses from which these were taken.
  static double errorOf(const std::vector<state_t>& states, const std::map<std::int64_t, std::size_t>& fed,
                        const FedSequence& sequence, std::size_t& compared) {
    const Trajectory truth = readTrajectory(sequence.folder + "/groundtruth.txt");
    Trajectory estimate, reference;
    for (const state_t& state : states) {
      const auto index = fed.find(state.frame);
      if (!isMeasured(state) || index == fed.end()) continue;
      const std::int64_t time_ns = sequence.times_ns[index->second];
      for (const StampedPose& pose : truth) {
        if (std::abs(pose.time_ns - time_ns) > 1'000'000) continue;
        estimate.push_back({state.utime * 1000, trajectoryOf({state})[0].world_T_camera});
        reference.push_back({state.utime * 1000, pose.world_T_camera});
        break;
      }
    }
    compared = estimate.size();
    return absoluteError(estimate, reference, Alignment::similarity).translation.rmse;
  }

  const std::string device_ = environment("EDGESLAM_LOOPBACK");
  TemporaryFolder folder_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace edgeslam
