// What tracking hands to mapping, and what it gets back of a frame that was lost: frames and tracks as values.
#pragma once

#include <cstddef>

#include "geometry/camera.h"
#include "map/keyframe.h"
#include "tracking/followed_frame.h"

namespace edgeslam {

// What a frame is for mapping.
struct FrameRole {
  FrameKind kind = FrameKind::start;
  KeyframeId keyframe = -1;  // its number, or -1
  const char* reason = "";   // which criterion made it a keyframe
  double noise_factor = 1;   // of what is measured in it
  int world = 0;             // that its pose is in, or the last pose was in
  std::int64_t start = -1;   // first frame of the start that it helps
};

// Writes over `description`, with its memory. A frame that only helps a start has no images in it.
void describe(const Camera& camera, const FollowedFrame& frame, const FrameRole& role, TrackedFrame& description);

// Gives it memory for so many observations, and for what an inertial unit measures.
void reserve(std::size_t observations, bool has_inertia, TrackedFrame& description);

// A map point found again in a frame whose pose was lost.
struct FoundAgain {
  PointId point = 0;
  Measurement measurement;
  bool corner = false;
};

Track trackOf(const FoundAgain& found);

}  // namespace edgeslam
