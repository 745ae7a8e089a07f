#include "visual_odometry/odometry_frame.h"

#include "geometry/uncertainty.h"

namespace edgeslam {

OdometryFrame moved(const OdometryFrame& before, const MotionStep& step) {
  return {before.odom_T_camera * step.before_T_now,
          carriedCovariance(before.covariance, step.before_T_now) + step.covariance,
          before.resets + (step.is_broken ? 1 : 0)};
}

std::optional<OdometryFrame> CameraOdometry::next(const FrameResult& result) {
  const std::optional<MotionStep> step = steps_.next(result);
  if (!step) return std::nullopt;
  frame_ = moved(frame_, *step);
  return frame_;
}

}  // namespace edgeslam
