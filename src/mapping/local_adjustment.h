// P18, P19: bundle adjustment of the new keyframe, its covisible keyframes and all the points and lines that they see;
// keyframes outside that see these are held fixed. Where hardly more than lines are in view, which few keyframes see
// well together, all that see them are free.
#pragma once

#include <optional>

#include "adjustment/bundle_adjustment.h"
#include "geometry/camera.h"
#include "map/map.h"
#include "mapping/line_options.h"
#include "wheels/wheel_motion.h"

namespace edgeslam {

struct LocalAdjustmentOptions {
  int free_keyframes = 8;        // the new one and its best covisible ones
  int fixed_keyframes = 20;      // most that only hold the gauge
  int covisible_points = 100;    // common points that make two keyframes covisible ...
  double covisible_share = 0.3;  // ... or this share of the most that any shares with the new one
  double outlier = 5.0;          // whitened; larger than noise allows: old points seen again after drift must stay in
  double largest_depth_sigma = 0.5;  // points whose depth is less certain than this share of it are taken out
  BundleOptions bundle{8, 2.0};
  LineOptions lines;
  std::optional<InertialUnit>
      inertia;  // what it felt between keyframes counts in worlds whose lie to the earth is known
  std::optional<WheelOptions> wheels;  // that turn beneath the camera; without: the camera alone
  // Scale, gravity and biases are adjusted, too, with their deviations, from where the map has them.
  bool inertia_is_free = false;
};

// Adjusts around the latest keyframe; takes out outliers and points that lost their depth. False where the solver
// failed (the map is then as it was).
bool adjustLocally(const Camera& camera, const LocalAdjustmentOptions& options, Map& map);

// Adjusts the given keyframes and the points that they see; `fixed` ones only hold the gauge. False also where
// `interrupted` became true. `cost`: what is left of the robust cost, where asked for.
bool adjustKeyframes(const Camera& camera, const LocalAdjustmentOptions& options, const std::vector<KeyframeId>& free,
                     const std::vector<KeyframeId>& fixed, Map& map, const std::atomic<bool>* interrupted = nullptr,
                     double* cost = nullptr);

}  // namespace edgeslam
