// P20: bundle adjustment of all keyframes and points. It is mapping's, as local adjustment is, but takes so long that
// places' thread does it, on a copy of the map.
#pragma once

#include "mapping/local_adjustment.h"

namespace edgeslam {

struct GlobalAdjustmentOptions {
  BundleOptions bundle{10, 2.0};
};

// Adjusts all of the latest keyframe's world; takes out outliers and points that lost their depth, as `local` says. Its
// first keyframe stays where it is, and the keyframe farthest from that keeps its distance. False where the solver
// failed or there are fewer than 2 keyframes, or where `interrupted` became true (the map is then as it was).
bool adjustGlobally(const Camera& camera, const GlobalAdjustmentOptions& options, const LocalAdjustmentOptions& local,
                    Map& map, const std::atomic<bool>* interrupted = nullptr);

}  // namespace edgeslam
