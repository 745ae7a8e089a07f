// Frames of a camera that moves steadily, as tracking tells them: the motion from frame to frame in the map as it is.
#pragma once

#include "tracking/frame_result.h"

namespace edgeslam::test {

constexpr std::int64_t frame_interval_ns = 33333333;

class MovingCamera {
 public:
  explicit MovingCamera(const Pose& step) : step_(step) {}

  // The next frame, measured from the frame that was located before.
  FrameResult tracked() {
    FrameResult frame = next();
    frame.state = TrackingState::tracking;
    frame.has_pose = true;
    setCovariance(1e-6, frame);
    located();
    return frame;
  }
  // Predicted as standing `off` from where it is, in the frame of where it was measured last.
  FrameResult predicted(const Eigen::Vector3d& off = Eigen::Vector3d::Zero()) {
    FrameResult frame = next();
    frame.state = TrackingState::predicted;
    frame.has_pose = true;
    const Pose world_T_previous = world_T_camera_ * since_located_.inverse();
    frame.previous_T_camera.translation += off;
    frame.world_T_camera.translation += world_T_previous.rotation * off;
    setCovariance(1e-6 + 1e-4 * ++frames_since_, frame);
    return frame;
  }
  FrameResult lost() {
    FrameResult frame = predicted();
    frame.state = TrackingState::lost;
    frame.has_pose = false;
    frame.world = -1;
    return frame;
  }
  FrameResult held() {
    FrameResult frame = tracked();
    frame.position_is_held = true;
    frame.previous_T_camera.translation.setZero();
    for (Matrix6d* covariance : {&frame.covariance, &frame.world_covariance}) {
      covariance->diagonal().head<3>().array() += 1e-4;
    }
    was_held_ = true;
    return frame;
  }
  // The whole map is moved, as a loop does.
  void correctMap(const Pose& new_world_T_world) {
    world_T_camera_ = new_world_T_world * world_T_camera_;
    ++corrections_;
  }
  void enterWorld(int world) { world_ = world; }
  void forgetLocated() { previous_ns_ = -1; }

 private:
  // In the world it grows along the way.
  void setCovariance(double variance, FrameResult& frame) const {
    frame.covariance = variance * Matrix6d::Identity();
    frame.world_covariance = frame.covariance + 1e-7 * static_cast<double>(index_) * Matrix6d::Identity();
  }
  FrameResult next() {
    world_T_camera_ = world_T_camera_ * step_;
    since_located_ = since_located_ * step_;
    FrameResult frame;
    frame.index = index_;
    frame.time_ns = 1000000000 + index_++ * frame_interval_ns;
    frame.world = world_;
    frame.world_T_camera = world_T_camera_;
    frame.map_corrections = corrections_;
    frame.has_motion = previous_ns_ >= 0;
    frame.previous_time_ns = previous_ns_;
    frame.previous_T_camera = since_located_;
    frame.previous_position_was_held = was_held_;
    now_ns_ = frame.time_ns;
    return frame;
  }
  void located() {
    previous_ns_ = now_ns_;
    since_located_ = Pose();
    frames_since_ = 0;
    was_held_ = false;
  }

  Pose step_, world_T_camera_, since_located_;
  std::int64_t index_ = 0, now_ns_ = 0, previous_ns_ = -1;
  std::int64_t corrections_ = 0;
  int world_ = 0, frames_since_ = 0;
  bool was_held_ = false;
};

}  // namespace edgeslam::test
