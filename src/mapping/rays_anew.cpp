#include "mapping/rays_anew.h"

#include <algorithm>

namespace edgeslam {
namespace {

void takeRaysAnew(const Camera& camera, Keyframe& keyframe) {
  std::vector<PointObservation> observations(keyframe.observations.begin(), keyframe.observations.end());
  for (PointObservation& seen : observations) {
    const Eigen::Vector2d& pixel = seen.measurement.pixel;
    seen.bearing = rayOfRow(camera, keyframe.twist, pixel.y(), bearing(camera, pixel)).direction;
  }
  keyframe.observations = std::move(observations);
  for (SeenEdge& edge : keyframe.straight_edges) {
    for (EdgeEnd* end : {&edge.from, &edge.to}) end->bearing = bearing(camera, end->pixel);
  }
}

}  // namespace

void takeRaysAnew(const Camera& camera, const std::vector<KeyframeId>& keyframes, Map& map) {
  std::vector<bool> is_taken(numberOfKeyframes(map), false);
  for (const KeyframeId id : keyframes) {
    is_taken[static_cast<std::size_t>(id)] = true;
    takeRaysAnew(camera, map.keyframes[id]);
  }
  for (auto& [id, point] : map.points) {
    if (!is_taken[static_cast<std::size_t>(point.host)]) continue;
    const Keyframe& host = map.keyframes[point.host];
    const PointObservation* seen = findObservation(host, id);
    if (!seen) continue;
    setPlace(rowPose(camera, host.twist, seen->measurement.pixel.y()).translation, seen->bearing, point.inverse_depth,
             point.inverse_depth_sigma, point);
  }
}

}  // namespace edgeslam
