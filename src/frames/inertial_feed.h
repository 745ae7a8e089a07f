// Gives a run what an inertial unit measured beside recorded frames, as the frames come.
#pragma once

#include <cstdint>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam {

class InertialFeed {
 public:
  // `samples` must outlive it; their times ascend. `offset_ns`: of the unit's clock from the camera's.
  InertialFeed(const std::vector<InertialSample>& samples, std::int64_t offset_ns)
      : samples_(samples), offset_ns_(offset_ns) {}

  // Before each frame: gives what was measured until then, and the first after it, which a frame between two needs.
  template <typename Give>
  void giveUntil(std::int64_t frame_ns, const Give& give) {
    const std::int64_t until_ns = frame_ns + offset_ns_;
    while (next_ < samples_.size() && (next_ == 0 || samples_[next_ - 1].time_ns < until_ns)) give(samples_[next_++]);
  }

 private:
  const std::vector<InertialSample>& samples_;
  std::int64_t offset_ns_;
  std::size_t next_ = 0;
};

}  // namespace edgeslam
