#include "mapping/global_adjustment.h"

#include "map/worlds.h"

namespace edgeslam {

bool adjustGlobally(const Camera& camera, const GlobalAdjustmentOptions& options, const LocalAdjustmentOptions& local,
                    Map& map, const std::atomic<bool>* interrupted) {
  LocalAdjustmentOptions adjustment = local;
  adjustment.bundle = options.bundle;
  if (map.keyframes.empty()) return false;
  const std::vector<KeyframeId> all = keyframesOf(map, map.keyframes.back().world);
  if (all.size() < 2) return false;
  return adjustKeyframes(camera, adjustment, all, {}, map, interrupted);
}

}  // namespace edgeslam
