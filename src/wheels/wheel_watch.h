// Tells what is wrong with what the wheels say, from the data alone: jumps, and how it comes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "samples/arrival_watch.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

class WheelWatch {
 public:
  WheelWatch();

  // In the order in which they come, a frame after the poses that were there before it.
  void add(const OdometryPose& pose);
  void addFrame(std::int64_t time_ns) { arrivals_.addFrame(time_ns); }

  // In a line, of what came lately; empty where nothing is wrong, or nothing can be said yet.
  std::string problem() const;

 private:
  ArrivalWatch arrivals_;
  std::optional<OdometryPose> last_;
  std::array<bool, ArrivalWatch::window> jumped_{};  // a ring
  std::size_t count_ = 0;                            // ever
};

}  // namespace edgeslam
