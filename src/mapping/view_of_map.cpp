#include "mapping/view_of_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "geometry/angles.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

double medianDepth(const Map& map, const Keyframe& keyframe) {
  std::vector<double> depths;
  for (const PointObservation& observation : keyframe.observations) {
    const auto point = map.points.find(observation.point);
    if (point == map.points.end()) continue;
    depths.push_back((worldPosition(map, point->second) - keyframe.world_T_camera.translation).norm());
  }
  return depths.empty() ? 0 : upperMedian(depths);
}

// By keyframe: whether its points are in the view.
std::vector<char> keyframesInView(const Map& map, KeyframeId centre, const ViewOptions& options) {
  const Keyframe& latest = map.keyframes[centre];
  const double reach = options.largest_distance * medianDepth(map, latest);
  std::vector<char> in_view(numberOfKeyframes(map), 0);
  std::vector<std::pair<double, KeyframeId>> near;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != latest.world) continue;
    if (keyframe.id <= latest.id && keyframe.id + options.latest_keyframes > latest.id) {
      in_view[static_cast<std::size_t>(keyframe.id)] = 1;
      continue;
    }
    const double distance = (keyframe.world_T_camera.translation - latest.world_T_camera.translation).norm();
    const double turn = degrees(rotationAngle(keyframe.world_T_camera.rotation, latest.world_T_camera.rotation));
    if (distance < reach && turn < options.largest_turn_deg) {
      near.emplace_back(distance / reach + turn / options.largest_turn_deg, keyframe.id);
    }
  }
  std::sort(near.begin(), near.end());
  for (std::size_t i = 0; i < near.size() && i < static_cast<std::size_t>(options.near_keyframes); ++i) {
    in_view[static_cast<std::size_t>(near[i].second)] = 1;
  }
  return in_view;
}

// The latest keyframe with images that saw the point, or -1.
KeyframeId latestSource(const Map& map, const MapPoint& point) {
  for (auto id = point.seen_in.rbegin(); id != point.seen_in.rend(); ++id) {
    if (map.keyframes[*id].images) return *id;
  }
  return map.keyframes[point.host].images ? point.host : -1;
}

// The one among them that saw it most nearly from where the camera of `centre` is.
KeyframeId nearestSource(const Map& map, const MapPoint& point, const Keyframe& centre) {
  const Eigen::Vector3d position = worldPosition(map, point);
  const Eigen::Vector3d ray = position - centre.world_T_camera.translation;
  KeyframeId nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](KeyframeId id) {
    const Keyframe& keyframe = map.keyframes[id];
    if (!keyframe.images) return;
    const double difference = (ray - (position - keyframe.world_T_camera.translation)).norm();
    if (difference >= least) return;
    least = difference;
    nearest = id;
  };
  consider(point.host);
  for (const KeyframeId id : point.seen_in) consider(id);
  return nearest;
}

void writeSource(const Map& map, const MapPoint& point, KeyframeId source, ViewPoint& view_point) {
  if (source < 0) return;
  const PointObservation* observation = findObservation(map.keyframes[source], point.id);
  view_point.source = source;
  view_point.source_measurement = observation->measurement;
  view_point.corner = observation->corner;
}

}  // namespace

MapView viewOfMap(const Map& map, KeyframeId centre, const ViewOptions& options) {
  assert(map.keyframes.contains(centre));
  MapView view;
  view.world = map.keyframes[centre].world;
  if (const auto known = map.inertia.find(view.world); known != map.inertia.end()) view.inertia = known->second;
  if (const auto known = map.wheels.find(view.world); known != map.wheels.end()) view.wheels = known->second;
  view.centre = centre;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != view.world) continue;
    view.keyframes.push_back({keyframe.id, keyframe.world_T_camera, nullptr, keyframe.uncertainty, keyframe.twist});
  }
  const std::vector<char> in_view = keyframesInView(map, centre, options);
  for (const auto& [id, point] : map.points) {
    const auto seen = [&](KeyframeId keyframe) { return in_view[static_cast<std::size_t>(keyframe)] != 0; };
    if (!seen(point.host) && std::none_of(point.seen_in.begin(), point.seen_in.end(), seen)) continue;
    ViewPoint view_point;
    view_point.id = id;
    view_point.host = point.host;
    view_point.host_bearing = point.host_bearing;
    view_point.inverse_depth = point.inverse_depth;
    view_point.inverse_depth_sigma = point.inverse_depth_sigma;
    const KeyframeId source =
        options.nearest_sources ? nearestSource(map, point, map.keyframes[centre]) : latestSource(map, point);
    writeSource(map, point, source, view_point);
    if (view_point.source >= 0) {
      view.keyframes[view_point.source].images = map.keyframes[view_point.source].images.get();
    }
    view.points.push_back(view_point);
  }
  return view;
}

}  // namespace edgeslam
