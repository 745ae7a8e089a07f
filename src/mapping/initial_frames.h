// The frames that a map may be started from: the first one, whose points are to get depths, and those since.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "map/keyframe.h"

namespace edgeslam {

struct InitialFrames {
  TrackedFrame first;
  std::vector<TrackedFrame> since;  // ascending; world_T_camera is provisional, in the first frame's camera

  const TrackedFrame& current() const { return since.back(); }
};

// Takes over the next frame, without points that the first one has not. Of a camera that hardly moves every second
// frame is kept.
void addFrame(InitialFrames& frames, const TrackedFrame& frame);

// Indices into `since` of up to `count` frames, spread evenly; the last one is the current frame.
std::vector<std::size_t> spreadFrames(const InitialFrames& frames, int count);

// How many of the first frame's points the current one sees as corner-like.
int cornersSeen(const InitialFrames& frames);

// Unit bearings of the points that both frames see, each in its frame's camera.
struct CommonBearings {
  std::vector<Eigen::Vector3d> in_first, in_other;
};
CommonBearings commonBearings(const TrackedFrame& first, const TrackedFrame& other);

}  // namespace edgeslam
