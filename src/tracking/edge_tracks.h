// Tracks on straight edges: a line of space gives them their depths, so that mapping is told which they are.
#pragma once

#include "edges/straight_edges.h"
#include "tracking/followed_frame.h"

namespace edgeslam {

// Brings tracks that are not corner-like back onto the straight edges that they lie on: their patches, which are
// renewed at keyframes, slowly walk off.
void putOnStraightEdges(const Camera& camera, const StraightEdges& straight, FollowedFrame& frame);

// Keeps in the frame the straight edges that at least three of its tracks lie on, and in these tracks which it is.
// `noise_factor`: how many times as far as presumed measurements err.
void keepStraightEdges(const Camera& camera, const StraightEdges& straight, double noise_factor, FollowedFrame& frame,
                       std::pmr::memory_resource* memory);

}  // namespace edgeslam
