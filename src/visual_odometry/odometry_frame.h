// Where the camera is in a frame that never jumps: `odom` of REP 105. It begins at the first measured pose, goes on by
// motion alone, and drifts.
#pragma once

#include "visual_odometry/motion_step.h"

namespace edgeslam {

struct OdometryFrame {
  Pose odom_T_camera;                      // or of the body that carries it
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update, since the start
  Matrix6d drift = Matrix6d::Zero();       // the part of it that stays; the rest is of the pose now
  int resets = 0;  // how often the motion in between was not known: it goes on from where it was
};

OdometryFrame moved(const OdometryFrame& before, const MotionStep& step);

// The camera's own, in map units.
class CameraOdometry {
 public:
  // All frames, in order. None where there is no step to a frame.
  std::optional<OdometryFrame> next(const FrameResult& result);

 private:
  MotionSteps steps_;
  OdometryFrame frame_;
};

}  // namespace edgeslam
