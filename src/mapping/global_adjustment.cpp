#include "mapping/global_adjustment.h"

namespace edgeslam {

bool adjustGlobally(const Camera& camera, const GlobalAdjustmentOptions& options, const LocalAdjustmentOptions& local,
                    Map& map, const std::atomic<bool>* interrupted) {
  if (map.keyframes.size() < 2) return false;
  LocalAdjustmentOptions adjustment = local;
  adjustment.bundle = options.bundle;
  std::vector<KeyframeId> all;
  for (const Keyframe& keyframe : map.keyframes) all.push_back(keyframe.id);
  return adjustKeyframes(camera, adjustment, all, {}, map, interrupted);
}

}  // namespace edgeslam
