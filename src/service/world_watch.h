// Which world the camera is in, and what is told where that changes: a new map was begun beside the others, or the
// camera is back in one that is known.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "tracking/frame_result.h"

namespace edgeslam {

// For the publishing thread.
class WorldWatch {
 public:
  // Another run, over another map.
  void begin();

  // Each frame, in order. A line for the log where its pose is in another world than the one before.
  std::optional<std::string> frame(const FrameResult& result);

  // That the last pose was in; -1 before the first.
  int world() const { return world_; }
  // Worlds with poses, less those that were joined while the camera was in them.
  int count() const { return static_cast<int>(seen_.size()); }

 private:
  std::set<int> seen_;
  int world_ = -1;
  std::string why_lost_;  // before the last pose
};

}  // namespace edgeslam
