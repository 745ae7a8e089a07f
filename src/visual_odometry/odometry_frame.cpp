#include "visual_odometry/odometry_frame.h"

#include "geometry/uncertainty.h"

namespace edgeslam {

OdometryFrame moved(const OdometryFrame& before, const MotionStep& step) {
  OdometryFrame now;
  const Pose before_T_now = step.before_T_now * step.taken_back;
  now.odom_T_camera = before.odom_T_camera * before_T_now;
  now.drift = carriedCovariance(before.drift, before_T_now) + step.drift;
  now.covariance = now.drift + step.pose_covariance;
  now.resets = before.resets + (step.is_broken ? 1 : 0);
  return now;
}

std::optional<OdometryFrame> CameraOdometry::next(const FrameResult& result) {
  const std::optional<MotionStep> step = steps_.next(result);
  if (!step) return std::nullopt;
  frame_ = moved(frame_, *step);
  return frame_;
}

}  // namespace edgeslam
