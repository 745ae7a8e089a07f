// A walk whose camera has a rolling shutter, mapped as if it had none.
#pragma once

#include "mapping/rays_anew.h"
#include "unit/mapping/landmark_walk.h"

namespace edgeslam::test {

inline std::vector<KeyframeId> allKeyframes(const Map& map) {
  std::vector<KeyframeId> all;
  for (const Keyframe& keyframe : map.keyframes) all.push_back(keyframe.id);
  return all;
}

// `readout_s`: the camera's. `motion`: largest speed [map units/s] and turn rate [rad/s] while rows are read. `noise`:
// of the measurements [px].
inline Walk rollingWalk(std::uint64_t seed, int keyframes, double readout_s, double motion, double noise,
                        double largest_roll = 0) {
  Walk walk(seed);
  walk.largest_roll = largest_roll;
  for (int k = 0; k < keyframes; ++k) walk.step();
  Camera rolling = Walk::camera();
  rolling.readout_s = readout_s;
  for (Keyframe& keyframe : walk.map.keyframes) {
    keyframe.time_ns = std::int64_t{100'000'000} * keyframe.id;
    keyframe.twist << uniformVector(walk.random, motion), uniformVector(walk.random, motion);
    std::vector<PointObservation> observations(keyframe.observations.begin(), keyframe.observations.end());
    for (PointObservation& seen : observations) {
      const Eigen::Vector3d in_camera =
          keyframe.world_T_camera.inverse() * walk.landmarks[static_cast<std::size_t>(seen.point)];
      seen.measurement.pixel = projectToRow(rolling, keyframe.twist, in_camera);
      seen.measurement.pixel += Eigen::Vector2d(gaussian(walk.random, noise), gaussian(walk.random, noise));
    }
    keyframe.observations = std::move(observations);
  }
  takeRaysAnew(Walk::camera(), allKeyframes(walk.map), walk.map);
  return walk;
}

}  // namespace edgeslam::test
