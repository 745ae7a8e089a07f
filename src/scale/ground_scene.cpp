// What of the map the ground is looked for in.
#include <algorithm>
#include <map>
#include <utility>

#include "scale/ground_plane.h"

namespace edgeslam {
namespace {

constexpr double largest_depth_sigma = 0.1;  // share of the distance
constexpr double least_depression = 0.1;     // sine of the angle below the horizon: by the tilt of what is vertical

}  // namespace

GroundScene groundScene(const Map& map, const Eigen::Vector3d& camera_up, const GroundOptions& options) {
  GroundScene scene;
  std::map<KeyframeId, std::size_t> cameras;  // of the latest keyframes
  const auto count = static_cast<std::ptrdiff_t>(map.keyframes.size());
  for (auto at = map.keyframes.end() - std::min<std::ptrdiff_t>(count, options.latest_keyframes);
       at != map.keyframes.end(); ++at) {
    if (at->world != map.keyframes.back().world) continue;
    cameras[at->id] = scene.cameras.size();
    scene.cameras.push_back(at->world_T_camera.translation);
    scene.ups.push_back(at->world_T_camera.rotation * camera_up);
  }
  std::map<std::pair<KeyframeId, int>, int> edges;
  for (const auto& [id, point] : map.points) {
    const auto host = cameras.find(point.host);
    const bool known =
        point.inverse_depth > 0 && point.inverse_depth_sigma <= largest_depth_sigma * point.inverse_depth;
    if (host == cameras.end() || !known) continue;
    if (point.host_bearing.dot(camera_up) > -least_depression) continue;
    const Eigen::Vector3d position = worldPosition(map, point);
    if (!position.allFinite()) continue;
    const auto next_edge = static_cast<int>(edges.size());
    // A point without an edge is one of its own.
    const std::pair<KeyframeId, int> edge(point.chain_keyframe, point.chain >= 0 ? point.chain : -1 - next_edge);
    scene.points.push_back({position, point.inverse_depth_sigma / point.inverse_depth, host->second,
                            edges.emplace(edge, next_edge).first->second});
  }
  return scene;
}

}  // namespace edgeslam
