// Points of straight edges slide along them unnoticed; once the frame's pose is known each is moved along its edge to
// where its map point projects (design, section 5: flow, "damped along the edge").
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/track.h"

namespace edgeslam {

struct EdgeLockOptions {
  bool enabled = true;
  double straightness = 0.1;  // locked where sigma_normal < straightness * sigma_tangent
  double longest_move = 4.0;  // [px]
};

void lockAlongEdges(const Camera& camera, const MapView& view, const MovingCamera& moving,
                    const EdgeLockOptions& options, std::vector<Track>& tracks);

}  // namespace edgeslam
