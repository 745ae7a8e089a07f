#include "mapping/global_adjustment.h"

#include <cmath>

namespace edgeslam {
namespace {

// Of the keyframes from keyframe 0, root mean square.
double sizeOf(const Map& map) {
  const Eigen::Vector3d& origin = map.keyframes.front().world_T_camera.translation;
  double squares = 0;
  for (const Keyframe& keyframe : map.keyframes)
    squares += (keyframe.world_T_camera.translation - origin).squaredNorm();
  return std::sqrt(squares / static_cast<double>(map.keyframes.size()));
}

void scaleMap(double scale, Map& map) {
  const Eigen::Vector3d origin = map.keyframes.front().world_T_camera.translation;
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.world_T_camera.translation = origin + scale * (keyframe.world_T_camera.translation - origin);
  }
  for (auto& [id, point] : map.points) {
    point.inverse_depth /= scale;
    point.inverse_depth_sigma /= scale;
  }
}

}  // namespace

bool adjustGlobally(const Camera& camera, const GlobalAdjustmentOptions& options, const LocalAdjustmentOptions& local,
                    Map& map) {
  if (map.keyframes.size() < 2) return false;
  const double size = sizeOf(map);
  LocalAdjustmentOptions adjustment = local;
  adjustment.bundle = options.bundle;
  std::vector<KeyframeId> all;
  for (const Keyframe& keyframe : map.keyframes) all.push_back(keyframe.id);
  if (!adjustKeyframes(camera, adjustment, all, {}, map)) return false;
  // That keeps the newest keyframe's distance from the oldest, which is next to nothing after a loop.
  const double scale = size / sizeOf(map);
  if (std::isfinite(scale) && scale > 0) scaleMap(scale, map);
  return true;
}

}  // namespace edgeslam
