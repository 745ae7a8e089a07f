// A walk that is mapped with a calibration whose lens is not the camera's.
#pragma once

#include "geometry/distortion_reach.h"
#include "mapping/camera_trial.h"
#include "unit/mapping/rolling_walk.h"

namespace edgeslam::test {

inline LookedAt lookedAt(const Camera& camera, const Walk& walk) {
  return *lookAt(camera, {}, {}, allKeyframes(walk.map), walk.map);
}

inline Camera withFocalLengths(Camera camera, double times) {
  camera.fx *= times;
  camera.fy *= times;
  return camera;
}

inline Camera withDistortion(Camera camera, double more) {
  camera.distortion[0] += more;
  return camera;
}

constexpr double roll_that_tells = 1.2;  // the principal point [rad]

inline Camera withPrincipalPointMoved(Camera camera, const Eigen::Vector2d& by_px) {
  camera.cx += by_px.x();
  camera.cy += by_px.y();
  return camera;
}

// The map of a global shutter, with the rays that a wrong calibration gives it.
inline Walk mappedWith(const Camera& wrong, std::uint64_t seed, double largest_roll = 0) {
  Walk walk = rollingWalk(seed, 20, 0, 0.5, 0.2, largest_roll);
  takeRaysAnew(wrong, allKeyframes(walk.map), walk.map);
  return walk;
}

// What it moves at the corner, share of the distance from the centre.
inline double movedAtCorner(const FoundCamera& found) {
  const double corner = farthestCorner(Walk::camera()), squared = corner * corner;
  return found.radial[0] * squared + found.radial[1] * squared * squared;
}

}  // namespace edgeslam::test
