// The frames that were located last, where the map has them now: where it was adjusted meanwhile, the way from frame to
// frame is the same, only elsewhere. Else the adjustment would pass for motion.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "tracking/motion_model.h"

namespace edgeslam {

// `Frame` has a member `camera`, a TimedCamera.
template <typename Frame, std::size_t most>
class LatestFrames {
 public:
  // `last`: the one before, as the map has it now.
  void add(const TimedCamera& last, const Frame& frame) {
    moveAlongWith(last);
    frames_[count_++ % most] = frame;
  }
  void forget() { count_ = 0; }

  std::size_t size() const { return std::min(count_, most); }
  // So many before the latest.
  const Frame& before(std::size_t back) const { return frames_[(count_ - 1 - back) % most]; }

 private:
  void moveAlongWith(const TimedCamera& last) {
    if (count_ == 0 || before(0).camera.time_ns != last.time_ns) return;
    const Pose new_T_old = last.world_T_camera * before(0).camera.world_T_camera.inverse();
    for (Frame& frame : frames_) frame.camera.world_T_camera = new_T_old * frame.camera.world_T_camera;
  }

  std::array<Frame, most> frames_{};  // a ring
  std::size_t count_ = 0;             // of all that were located in a row
};

}  // namespace edgeslam
