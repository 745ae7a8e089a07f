// How well a pose is known in the world: in the map as it is, and how far the map itself may have drifted there.
#pragma once

#include <memory_resource>
#include <vector>

#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/track.h"

namespace edgeslam {

struct WorldUncertaintyOptions {
  // Errors of the map's points and of neighbours on an edge go together: the pose's standard deviations in the world
  // are so many times what independent measurements would give.
  double correlation_factor = 6;
  // Map points that contradict the pose go together, too (something that moves, a torn image): this share of those in
  // view doubles the pose's variance in the world, twice the share makes it five times as large.
  double doubling_outlier_share = 0.15;
  double calibration_sigma = 0.5;  // of directions, whatever is seen: no calibration is quite right [px]
};

// The map's own, where a camera with these tracks looks: two of three points in view are hosted by keyframes that are
// known at least as well, carried to the camera. Those that are known best do not speak for all: on an old edge that
// is still in view, or in again, hardly anything is known along it. `view` has a keyframe.
Matrix6d mapUncertaintyAt(const MapView& view, const std::vector<Track>& tracks, const Pose& world_T_camera,
                          std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// Covariance of a pose in the world. `covariance`: of the pose in the map as it is, `map_covariance`: the map's own
// there, `outlier_share`: of the map points in view. All are of the right-hand update [translation; rotation].
Matrix6d worldCovariance(const Camera& camera, const Matrix6d& covariance, const Matrix6d& map_covariance,
                         double outlier_share, const WorldUncertaintyOptions& options);

}  // namespace edgeslam
