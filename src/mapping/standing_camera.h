// P13: whether it is the camera that moves, or a thing before a camera that stands. Seen alone, a box that is carried
// by looks as if the camera went past it. But then much of the image stays where it is, which hardly happens to a
// camera that moves. A robot's own body stays, too: on one side of the image.
#pragma once

#include <string>
#include <vector>

#include "mapping/initial_frames.h"

namespace edgeslam {

class StandingCamera {
 public:
  // For another first frame.
  void forget() { still_.clear(); }

  // Looks at the first frame and the current one. Once the camera was seen to stand it does so until most of what was
  // still then has moved; points that are not followed any more do not tell. Against the next first frame less is
  // enough.
  bool stands(const Camera& camera, const InitialFrames& frames);

  // How it was seen to stand, in words.
  const std::string& description() const { return description_; }

 private:
  bool hasSetOff(const InitialFrames& frames) const;

  std::vector<PointId> still_;  // when it was first seen to stand, ascending; empty: it was not
  bool stood_ = false;          // and was not seen to move since
  std::string description_;
};

}  // namespace edgeslam
