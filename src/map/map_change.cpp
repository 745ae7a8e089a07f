#include "map/map_change.h"

#include <algorithm>
#include <iterator>

#include "geometry/median.h"

namespace edgeslam {
namespace {

// How much longer lengths around the keyframe became: the median over the points that it sees; `otherwise` where there
// are none.
double scaleAround(const Map& before, const Map& after, KeyframeId keyframe, double otherwise) {
  std::vector<double> ratios;
  for (const PointObservation& observation : before.keyframes[keyframe].observations) {
    const auto old_point = before.points.find(observation.point);
    const auto new_point = after.points.find(observation.point);
    if (old_point == before.points.end() || new_point == after.points.end()) continue;
    if (before.keyframes[old_point->second.host].world != before.keyframes[keyframe].world) continue;
    const auto distance = [&](const Map& map, const MapPoint& point) {
      return (worldPosition(map, point) - map.keyframes[keyframe].world_T_camera.translation).norm();
    };
    const double old_distance = distance(before, old_point->second);
    if (old_distance > 0) ratios.push_back(distance(after, new_point->second) / old_distance);
  }
  return ratios.empty() ? otherwise : upperMedian(ratios);
}

Similarity moveOfLatest(const Map& before, const Map& after, double scale_without_points) {
  const Pose& old_pose = before.keyframes.back().world_T_camera;
  const Pose& new_pose = after.keyframes.back().world_T_camera;
  const double scale = scaleAround(before, after, before.keyframes.back().id, scale_without_points);
  const Eigen::Quaterniond rotation = (new_pose.rotation * old_pose.rotation.conjugate()).normalized();
  return {scale, rotation, new_pose.translation - scale * (rotation * old_pose.translation)};
}

void compareViews(const Map& after, PointId id, const MapPoint& old_point, const MapPoint& new_point,
                  MapChange& change) {
  std::vector<KeyframeId> erased, added;
  std::set_difference(old_point.seen_in.begin(), old_point.seen_in.end(), new_point.seen_in.begin(),
                      new_point.seen_in.end(), std::back_inserter(erased));
  std::set_difference(new_point.seen_in.begin(), new_point.seen_in.end(), old_point.seen_in.begin(),
                      old_point.seen_in.end(), std::back_inserter(added));
  for (const KeyframeId keyframe : erased) change.erased_views.emplace_back(id, keyframe);
  for (const KeyframeId keyframe : added) {
    change.added_views.push_back({keyframe, *findObservation(after.keyframes[keyframe], id)});
  }
}

void compareLines(const Map& before, const Map& after, MapChange& change) {
  for (const auto& [id, line] : before.lines) {
    const auto found = after.lines.find(id);
    if (found == after.lines.end()) {
      change.dissolved_lines.push_back(id);
    } else if (found->second.is_placed) {
      const MapLine& now = found->second;
      const double before_scale = line.in_host.point.norm(), scale = now.in_host.point.norm() / before_scale;
      change.lines[id] = {now.host, now.in_host, now.begin, now.end, line.is_placed && before_scale > 0 ? scale : 1};
    }
  }
}

void addView(const MapChange::View& view, Map& map) {
  Keyframe* keyframe = map.keyframes.find(view.keyframe);
  const auto point = map.points.find(view.observation.point);
  if (!keyframe || point == map.points.end() || point->second.host == view.keyframe) return;
  SharedList<PointObservation>& observations = keyframe->observations;
  const auto place = std::lower_bound(observations.begin(), observations.end(), view.observation.point,
                                      [](const PointObservation& o, PointId wanted) { return o.point < wanted; });
  if (place == observations.end() || place->point != view.observation.point) {
    observations.insert(place, view.observation);
  }
  std::vector<KeyframeId>& seen_in = point->second.seen_in;
  const auto among = std::lower_bound(seen_in.begin(), seen_in.end(), view.keyframe);
  if (among == seen_in.end() || *among != view.keyframe) seen_in.insert(among, view.keyframe);
}

}  // namespace

MapChange changeOf(const Map& before, const Map& after, const std::optional<WorldJoin>& join) {
  MapChange change;
  if (before.keyframes.empty()) return change;
  for (const Keyframe& keyframe : after.keyframes) {
    change.world_T_camera[keyframe.id] = keyframe.world_T_camera;
    change.twists[keyframe.id] = keyframe.twist;
  }
  for (const auto& [id, point] : before.points) {
    const auto found = after.points.find(id);
    if (found == after.points.end()) {
      change.erased_points.push_back(id);
      continue;
    }
    const MapPoint& now = found->second;
    change.depths[id] = {now.host, now.inverse_depth, now.inverse_depth_sigma, point.inverse_depth / now.inverse_depth};
    compareViews(after, id, point, now, change);
  }
  compareLines(before, after, change);
  change.newer_world = before.keyframes.back().world;
  const bool is_joined = join && join->from == change.newer_world;
  change.newer_S_world = moveOfLatest(before, after, is_joined ? join->to_S_from.scale : 1);
  change.join = join;
  return change;
}

void applyChange(const MapChange& change, Map& map) {
  if (change.empty()) return;
  const Similarity& move = change.newer_S_world;
  for (auto& [id, point] : map.points) {
    const auto depth = change.depths.find(id);
    if (depth != change.depths.end() && depth->second.host == point.host) {
      point.inverse_depth = depth->second.inverse_depth;
      point.inverse_depth_sigma = depth->second.inverse_depth_sigma;
    } else if (depth != change.depths.end() || map.keyframes[point.host].world == change.newer_world) {
      const double scale = depth != change.depths.end() ? depth->second.scale : move.scale;
      point.inverse_depth /= scale;
      point.inverse_depth_sigma /= scale;
    }
  }
  for (auto& [id, line] : map.lines) {
    const auto place = change.lines.find(id);
    if (place != change.lines.end() && place->second.host == line.host) {
      line.in_host = place->second.in_host;
      line.begin = place->second.begin;
      line.end = place->second.end;
    } else if (place != change.lines.end()) {
      scaleLine(place->second.scale, line);
    } else if (map.keyframes[line.host].world == change.newer_world) {
      scaleLine(move.scale, line);
    }
  }
  for (Keyframe& keyframe : map.keyframes) {
    const auto corrected = change.world_T_camera.find(keyframe.id);
    if (corrected != change.world_T_camera.end()) {
      keyframe.world_T_camera = corrected->second;
      keyframe.twist = change.twists.at(keyframe.id);
    } else if (keyframe.world == change.newer_world) {
      keyframe.world_T_camera = moved(move, keyframe.world_T_camera);
      keyframe.twist = moved(move, keyframe.twist);
    }
    if (change.join && keyframe.world == change.join->from) keyframe.world = change.join->to;
  }
  if (change.join) {
    joinInertia(*change.join, map);
    joinWheels(*change.join, map);
  }
  for (const PointId id : change.erased_points) map.points.erase(id);
  for (const LineId id : change.dissolved_lines) dissolveLine(id, map);
  for (const auto& [id, keyframe] : change.erased_views) {
    const auto point = map.points.find(id);
    if (point == map.points.end()) continue;
    std::vector<KeyframeId>& seen_in = point->second.seen_in;
    seen_in.erase(std::remove(seen_in.begin(), seen_in.end(), keyframe), seen_in.end());
    if (seen_in.empty()) map.points.erase(point);
  }
  for (const MapChange::View& view : change.added_views) addView(view, map);
}

}  // namespace edgeslam
