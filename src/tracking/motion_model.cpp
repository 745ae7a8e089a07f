#include "tracking/motion_model.h"

#include <algorithm>

namespace edgeslam {

void MotionModel::observe(const TimedCamera& before, const TimedCamera& now) {
  before_T_now_ = before.world_T_camera.inverse() * now.world_T_camera;
  interval_ns_ = now.time_ns - before.time_ns;
}

void MotionModel::forget() {
  before_T_now_ = Pose();
  interval_ns_ = 0;
}

RowMotion MotionModel::whileRowsAreRead(const TimedCamera& last, std::int64_t time_ns, bool map_stands) const {
  RowMotion motion;
  motion.world_T_before = last.world_T_camera;
  motion.seconds = static_cast<double>(time_ns - last.time_ns) * 1e-9;
  motion.is_known_from_before = map_stands && interval_ns_ > 0;
  if (interval_ns_ > 0) motion.before = twistBetween(Pose(), before_T_now_, static_cast<double>(interval_ns_) * 1e-9);
  return motion;
}

Pose MotionModel::predict(const TimedCamera& last, std::int64_t time_ns) const {
  if (interval_ns_ <= 0) return last.world_T_camera;
  constexpr double most_intervals = 3;
  const double ahead = static_cast<double>(time_ns - last.time_ns) / static_cast<double>(interval_ns_);
  const double share = std::min(ahead, most_intervals);
  const Pose motion{rotationExp(share * rotationLog(before_T_now_.rotation)), share * before_T_now_.translation};
  return last.world_T_camera * motion;
}

// Hand-held cameras accelerate by some 5 m/s^2 and 10 rad/s^2; lengths are in units of the scene's depth here.
Matrix6d MotionModel::predictedCovariance(const Matrix6d& covariance, double seconds) {
  const double translation = 2.0 * seconds * seconds, rotation = 5.0 * seconds * seconds;
  Matrix6d predicted = covariance;
  predicted.diagonal().head<3>().array() += translation * translation;
  predicted.diagonal().tail<3>().array() += rotation * rotation;
  return predicted;
}

}  // namespace edgeslam
