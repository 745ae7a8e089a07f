// What it costs to adjust some keyframes of a map with another camera than the one that their rays are of.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mapping/global_adjustment.h"

namespace edgeslam {

// Some keyframes of a map, adjusted by themselves.
struct LookedAt {
  Camera camera;  // that the map's rays are of
  LocalAdjustmentOptions adjustment;
  std::vector<KeyframeId> keyframes;
  Map map;
  double cost = 0;
};

// With what of a camera the adjustment costs least.
struct CameraEstimate {
  double value = 0;  // readout [s], logarithm of how many times as long the focal lengths are, or distortion
  double sigma = 0;  // standard deviation, if measurements err as they say
};

// Nothing where the adjustment failed.
std::optional<LookedAt> lookAt(const Camera& camera, const GlobalAdjustmentOptions& global,
                               const LocalAdjustmentOptions& local, const std::vector<KeyframeId>& keyframes,
                               const Map& map);

// The map without what other keyframes say of it. That is by the camera that there was, and holds on to that one.
Map seenBy(const std::vector<KeyframeId>& keyframes, Map map);

// What the adjustment costs with a camera: infinity where it fails, and where the camera folds the image, unless the
// one that there was does, too.
double costWith(const LookedAt& at, const Camera& camera);

// What share of a change to another camera takes off at least half of the cost that it is expected to: 1, or 1/2, 1/4,
// 1/8, or nothing of it.
double worthwhileShare(const LookedAt& at, const std::function<Camera(double share)>& with,
                       const std::function<double(double share)>& expected_gain);

}  // namespace edgeslam
