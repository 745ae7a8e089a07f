#include "mapping/new_points.h"

#include <cassert>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/three_view_check.h"
#include "geometry/triangulation.h"

namespace edgeslam {
namespace {

// Where a keyframe's camera was as it read the row of an observation.
Pose poseInRow(const Camera& camera, const Keyframe& keyframe, const PointObservation& seen) {
  return worldTRow(camera, {keyframe.world_T_camera, keyframe.twist}, seen.measurement.pixel.y());
}

// P7, for points that are known in both directions; where a point may slide along its edge the epipolar lines of the
// outer views need not cross at the same point of the edge, and the triangulation's own error is the check.
bool passesThreeViews(const Camera& camera, const Map& map, PointId id, const std::vector<KeyframeId>& views,
                      double limit) {
  if (views.size() < 3) return true;
  const Keyframe& first = keyframeOf(map, views[views.size() - 3]);
  const Keyframe& middle = keyframeOf(map, views[views.size() - 2]);
  const Keyframe& last = keyframeOf(map, views[views.size() - 1]);
  const PointObservation* a = findObservation(first, id);
  const PointObservation* b = findObservation(middle, id);
  const PointObservation* c = findObservation(last, id);
  if (!a->corner || !b->corner || !c->corner) return true;
  return threeViewError(camera, poseInRow(camera, first, *a), poseInRow(camera, middle, *b),
                        poseInRow(camera, last, *c), a->measurement.pixel, b->measurement,
                        c->measurement.pixel) < limit;
}

}  // namespace

void associate(Map& map, Candidates& candidates) {
  assert(!map.keyframes.empty());
  const Keyframe& keyframe = map.keyframes.back();
  for (const PointObservation& observation : keyframe.observations) {
    const auto point = map.points.find(observation.point);
    if (point != map.points.end()) {
      point->second.seen_in.push_back(keyframe.id);
    } else {
      candidates[observation.point].push_back(keyframe.id);
    }
  }
}

int addNewPoints(const Camera& camera, const NewPointOptions& options, Map& map, Candidates& candidates) {
  assert(!map.keyframes.empty());
  int added = 0;
  std::map<KeyframeId, double> scene_distances;  // of hosts
  const KeyframeId latest = map.keyframes.back().id;
  for (auto candidate = candidates.begin(); candidate != candidates.end();) {
    const auto& [id, views] = *candidate;
    if (views.back() != latest) {  // no longer followed
      candidate = candidates.erase(candidate);
      continue;
    }
    if (static_cast<int>(views.size()) < options.fewest_views ||
        !passesThreeViews(camera, map, id, views, options.three_view_error)) {
      ++candidate;
      continue;
    }
    const Keyframe& host = keyframeOf(map, views.front());
    const PointObservation& in_host = *findObservation(host, id);
    // A host that moved as it read the point's row saw it from elsewhere than its centre.
    const Eigen::Vector3d ray_origin = rowPose(camera, host.twist, in_host.measurement.pixel.y()).translation;
    const Pose world_T_ray{host.world_T_camera.rotation, host.world_T_camera * ray_origin};
    std::vector<TriangulationView> others;
    for (std::size_t k = 1; k < views.size(); ++k) {
      const Keyframe& view = keyframeOf(map, views[k]);
      const PointObservation& seen = *findObservation(view, id);
      others.push_back({poseInRow(camera, view, seen).inverse() * world_T_ray, seen.measurement});
    }
    const TriangulationResult depth = triangulate(camera, in_host.bearing, others);
    const bool good =
        depth.converged && depth.inverse_depth > 0 && depth.sigma < options.largest_depth_sigma * depth.inverse_depth &&
        degrees(depth.parallax) > options.least_parallax_deg && depth.largest_error < options.largest_error;
    if (!good) {
      ++candidate;
      continue;
    }
    const auto [scene, is_new_host] = scene_distances.emplace(host.id, 0);
    if (is_new_host) scene->second = sceneDistance(map, host, options.fewest_of_scene);
    if (depth.inverse_depth * options.least_distance * scene->second > 1) {
      ++candidate;
      continue;
    }
    MapPoint point;
    point.id = id;
    point.host = host.id;
    setPlace(ray_origin, in_host.bearing, depth.inverse_depth, depth.sigma, point);
    point.corner = in_host.corner;
    point.chain_keyframe = host.id;
    point.chain = in_host.chain;
    point.order = in_host.order;
    point.seen_in.assign(views.begin() + 1, views.end());
    map.points.emplace(id, std::move(point));
    ++added;
    candidate = candidates.erase(candidate);
  }
  return added;
}

}  // namespace edgeslam
