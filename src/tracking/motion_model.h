// The camera's motion from frame to frame: constant velocity, but not for long.
#pragma once

#include <cstdint>

#include "geometry/rolling_shutter.h"
#include "geometry/uncertainty.h"

namespace edgeslam {

struct TimedCamera {
  std::int64_t time_ns = 0;
  Pose world_T_camera;
};

class MotionModel {
 public:
  // `before` and `now`: two frames that were located one after the other, in the same world.
  void observe(const TimedCamera& before, const TimedCamera& now);
  // Lengths are in another unit from now on: so many of it an old one.
  void scale(double new_units_an_old_unit) { before_T_now_.translation *= new_units_an_old_unit; }
  // Nothing is known of the motion: the camera is taken to stand.
  void forget();

  // How `last` moved as it was read, and the frame to come will: the poses tell it. Without a map that stands, poses
  // are too rough to tell how the motion changes.
  RowMotion whileRowsAreRead(const TimedCamera& last, std::int64_t time_ns, bool map_stands) const;

  // world_T_camera at `time_ns`, after `last`. After a gap the camera has rather stopped than flown on.
  Pose predict(const TimedCamera& last, std::int64_t time_ns) const;

  // Covariance (right-hand update [translation; rotation]) of a predicted pose, `seconds` after one of `covariance`.
  static Matrix6d predictedCovariance(const Matrix6d& covariance, double seconds);

 private:
  Pose before_T_now_;
  std::int64_t interval_ns_ = 0;  // that the motion was observed over; 0: none was
};

}  // namespace edgeslam
