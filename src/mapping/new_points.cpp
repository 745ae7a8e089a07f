#include "mapping/new_points.h"

#include <cassert>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/three_view_check.h"
#include "geometry/triangulation.h"

namespace edgeslam {
namespace {

const Keyframe& keyframeOf(const Map& map, KeyframeId id) { return map.keyframes[id]; }

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
  return threeViewError(camera, first.world_T_camera, middle.world_T_camera, last.world_T_camera, a->measurement.pixel,
                        b->measurement, c->measurement.pixel) < limit;
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
    std::vector<TriangulationView> others;
    for (std::size_t k = 1; k < views.size(); ++k) {
      const Keyframe& view = keyframeOf(map, views[k]);
      others.push_back({view.world_T_camera.inverse() * host.world_T_camera, findObservation(view, id)->measurement});
    }
    const TriangulationResult depth = triangulate(camera, in_host.bearing, others);
    const bool good =
        depth.converged && depth.inverse_depth > 0 && depth.sigma < options.largest_depth_sigma * depth.inverse_depth &&
        degrees(depth.parallax) > options.least_parallax_deg && depth.largest_error < options.largest_error;
    if (!good) {
      ++candidate;
      continue;
    }
    MapPoint point;
    point.id = id;
    point.host = host.id;
    point.host_bearing = in_host.bearing;
    point.inverse_depth = depth.inverse_depth;
    point.inverse_depth_sigma = depth.sigma;
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
