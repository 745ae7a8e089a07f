// P20: bundle adjustment of all keyframes and points.
#pragma once

#include "mapping/local_adjustment.h"

namespace edgeslam {

struct GlobalAdjustmentOptions {
  BundleOptions bundle{10, 2.0};
};

// Adjusts the whole map; takes out outliers and points that lost their depth, as `local` says. Keyframe 0 stays where
// it is, and the keyframe farthest from it keeps its distance. False where the solver failed or there are fewer than 2
// keyframes (the map is then as it was).
bool adjustGlobally(const Camera& camera, const GlobalAdjustmentOptions& options, const LocalAdjustmentOptions& local,
                    Map& map);

}  // namespace edgeslam
