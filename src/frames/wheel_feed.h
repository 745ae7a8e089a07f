// Gives a run what the wheels told beside recorded frames, as the frames come.
#pragma once

#include <cstdint>
#include <vector>

#include "wheels/odometry_pose.h"
#include "wheels/utime.h"

namespace edgeslam {

class WheelFeed {
 public:
  // `poses` must outlive it; their times ascend.
  explicit WheelFeed(const std::vector<OdometryPose>& poses) : poses_(poses) {}

  // Before each frame: gives what was told until then, and the first after it, which a frame between two needs.
  template <typename Give>
  void giveUntil(std::int64_t frame_ns, const Give& give) {
    while (next_ < poses_.size() && (next_ == 0 || poses_[next_ - 1].utime <= utimeOf(frame_ns))) give(poses_[next_++]);
  }

 private:
  const std::vector<OdometryPose>& poses_;
  std::size_t next_ = 0;
};

}  // namespace edgeslam
