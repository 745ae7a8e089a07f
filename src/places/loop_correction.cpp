#include "places/loop_correction.h"

#include <algorithm>
#include <cmath>

#include "adjustment/pose_graph.h"
#include "adjustment/reprojection.h"
#include "geometry/camera_mask.h"
#include "geometry/median.h"
#include "map/worlds.h"
#include "places/known_frame.h"

namespace edgeslam {
namespace {

Similarity similarityOf(const Pose& pose) { return {1, pose.rotation, pose.translation}; }

double medianDistance(const PlaceView& view) {
  std::vector<double> distances;
  for (const PlacePoint& point : view.points) distances.push_back(point.position.norm());
  return distances.empty() ? 1 : upperMedian(distances);
}

// Keyframes that follow each other or share points are held as they are, and the loop as it was found.
PoseGraph graphOf(const Map& map, const std::vector<KeyframeId>& keyframes, KeyframeId current, KeyframeId candidate,
                  const Similarity& current_S_candidate, double length, const LoopCorrectionOptions& options) {
  PoseGraph graph;
  graph.length = length;
  const KnownFrame known = knownFrame(map, keyframeOf(map, current).world);
  graph.keeps_scale = known.metres_a_unit.has_value();
  graph.up = known.up;
  const auto nodeOf = [&](KeyframeId id) {
    return static_cast<int>(std::lower_bound(keyframes.begin(), keyframes.end(), id) - keyframes.begin());
  };
  for (const KeyframeId id : keyframes) {
    graph.nodes.push_back({similarityOf(keyframeOf(map, id).world_T_camera), graph.nodes.empty()});
  }
  for (const KeyframeId id : keyframes) {
    const Keyframe& keyframe = keyframeOf(map, id);
    const std::vector<int> shared = sharedPoints(map, keyframe.id);
    const int most = *std::max_element(shared.begin(), shared.end());
    const double needed = std::max<double>(options.covisible_points, options.covisible_share * most);
    for (const KeyframeId other_id : keyframes) {
      if (other_id >= keyframe.id) break;
      const Keyframe& other = keyframeOf(map, other_id);
      const bool consecutive = nodeOf(other.id) + 1 == nodeOf(keyframe.id);
      if (!consecutive && shared[static_cast<std::size_t>(other.id)] < needed) continue;
      const Pose from_T_to = other.world_T_camera.inverse() * keyframe.world_T_camera;
      graph.edges.push_back({nodeOf(other.id), nodeOf(keyframe.id), similarityOf(from_T_to), 1.0});
    }
  }
  Similarity loop = current_S_candidate;
  if (graph.keeps_scale) loop = {1, loop.rotation, loop.translation / std::sqrt(loop.scale)};
  graph.edges.push_back({nodeOf(current), nodeOf(candidate), loop, options.loop_weight});
  return graph;
}

PointObservation observationOf(const Camera& camera, PointId point, bool corner, const Measurement& measurement) {
  PointObservation observation;
  observation.point = point;
  observation.measurement = measurement;
  observation.bearing = bearing(camera, measurement.pixel);
  observation.corner = corner;
  return observation;
}

// Points of the old side, looked for in a neighbour of the current keyframe.
void observeInNeighbour(const Camera& camera, const Map& map, const PlaceView& old_side, const Pose& neighbour_T_old,
                        const Keyframe& neighbour, const LoopVerification& loop, double largest_move,
                        const GuidedMatchingOptions& guided, std::vector<LoopCorrection::Observation>& observations) {
  const std::shared_ptr<const FrameImages> images = neighbour.images.get();
  std::vector<PointId> found_before;
  for (const auto& found : loop.found) found_before.push_back(found.candidate_point);
  std::sort(found_before.begin(), found_before.end());
  for (const PlacePoint& point : old_side.points) {
    // Only points that agree with the similarity: merging is for those that meet.
    if (!std::binary_search(found_before.begin(), found_before.end(), point.id)) continue;
    if (findObservation(neighbour, point.id)) continue;
    Measurement measured;
    if (!predictMeasurement(camera, neighbour_T_old, point.position, point.measurement, measured)) continue;
    if (!isLookedAt(camera, measured.pixel, 8)) continue;
    if (!findByPatch(camera, map, old_side, point, neighbour_T_old, *images, largest_move, guided, measured)) {
      continue;
    }
    observations.push_back({neighbour.id, observationOf(camera, point.id, point.corner, measured)});
  }
}

// A keyframe of the world made since moves as the one before it.
void moveAlong(const std::map<KeyframeId, Similarity>& moves, int world, Map& map) {
  const auto moveOf = [&](KeyframeId id) -> const Similarity& {
    const auto after = moves.upper_bound(id);
    return after == moves.begin() ? after->second : std::prev(after)->second;
  };
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != world) continue;
    const Similarity& move = moveOf(keyframe.id);
    keyframe.world_T_camera = moved(move, keyframe.world_T_camera);
    keyframe.twist = moved(move, keyframe.twist);
  }
  for (auto& [id, point] : map.points) {
    if (map.keyframes[point.host].world != world) continue;
    const double scale = moveOf(point.host).scale;
    point.inverse_depth /= scale;
    point.inverse_depth_sigma /= scale;
  }
  for (auto& [id, line] : map.lines) {
    if (map.keyframes[line.host].world == world) scaleLine(moveOf(line.host).scale, line);
  }
}

}  // namespace

WorldJoin joinOf(const Map& map, KeyframeId current, KeyframeId candidate, const Similarity& current_S_candidate) {
  const Keyframe &here = keyframeOf(map, current), &there = keyframeOf(map, candidate);
  const Similarity there_S_here =
      similarityOf(there.world_T_camera) * current_S_candidate.inverse() * similarityOf(here.world_T_camera).inverse();
  if (here.world > there.world) return {here.world, there.world, there_S_here};
  return {there.world, here.world, there_S_here.inverse()};
}

bool computeCorrection(const Camera& camera, const Map& map, KeyframeId current, KeyframeId candidate,
                       const LoopVerification& loop, const LoopVerificationOptions& verification,
                       const LoopCorrectionOptions& options, LoopCorrection& correction) {
  correction = {};
  const PlaceView old_side = placeView(camera, map, candidate, verification.neighbours);
  correction.current = current;
  correction.candidate = candidate;
  correction.world = keyframeOf(map, current).world;
  if (keyframeOf(map, current).world != keyframeOf(map, candidate).world) {
    WorldJoin join = joinOf(map, current, candidate, loop.current_S_candidate);
    const Keyframe& of_younger = keyframeOf(map, keyframeOf(map, current).world == join.from ? current : candidate);
    join.to_S_from = putRight(knownFrame(map, join.from), knownFrame(map, join.to), join.to_S_from,
                              of_younger.world_T_camera.translation);
    correction.join = join;
  } else {
    const std::vector<KeyframeId> keyframes = keyframesOf(map, keyframeOf(map, current).world);
    PoseGraph graph =
        graphOf(map, keyframes, current, candidate, loop.current_S_candidate, medianDistance(old_side), options);
    if (!optimisePoseGraph(graph, options.iterations).usable) return false;
    for (std::size_t node = 0; node < keyframes.size(); ++node) {
      const Similarity& corrected = graph.nodes[node].world_S_node;
      correction.new_world_S_world[keyframes[node]] =
          corrected * similarityOf(keyframeOf(map, keyframes[node]).world_T_camera).inverse();
    }
  }

  for (const auto& found : loop.found) {
    if (findObservation(keyframeOf(map, current), found.candidate_point)) continue;
    const auto point = map.points.find(found.candidate_point);
    if (point == map.points.end()) continue;
    correction.observations.push_back(
        {current, observationOf(camera, found.candidate_point, point->second.corner, found.measurement)});
  }
  const Similarity old_S_current = loop.current_S_candidate.inverse();
  for (const KeyframeId id : covisibleWith(map, current, options.neighbours)) {
    const Keyframe& neighbour = keyframeOf(map, id);
    if (!neighbour.images || id == candidate) continue;
    const Similarity current_S_neighbour =
        similarityOf(keyframeOf(map, current).world_T_camera.inverse() * neighbour.world_T_camera);
    const Pose neighbour_T_old = upToScale((old_S_current * current_S_neighbour).inverse());
    observeInNeighbour(camera, map, old_side, neighbour_T_old, neighbour, loop, options.largest_move,
                       verification.guided, correction.observations);
  }
  std::stable_sort(correction.observations.begin(), correction.observations.end(),
                   [](const LoopCorrection::Observation& a, const LoopCorrection::Observation& b) {
                     return a.keyframe != b.keyframe ? a.keyframe < b.keyframe
                                                     : a.observation.point < b.observation.point;
                   });
  return true;
}

void applyCorrection(const LoopCorrection& correction, Map& map) {
  if (correction.join) joinWorlds(*correction.join, map);
  if (!correction.new_world_S_world.empty()) moveAlong(correction.new_world_S_world, correction.world, map);
  for (const auto& [id, observation] : correction.observations) {
    if (!map.keyframes.contains(id)) continue;
    const auto point = map.points.find(observation.point);
    if (point == map.points.end() || point->second.host == id) continue;
    Keyframe& keyframe = map.keyframes[id];
    const auto place = std::lower_bound(keyframe.observations.begin(), keyframe.observations.end(), observation.point,
                                        [](const PointObservation& o, PointId wanted) { return o.point < wanted; });
    if (place != keyframe.observations.end() && place->point == observation.point) continue;
    keyframe.observations.insert(place, observation);
    std::vector<KeyframeId>& seen_in = point->second.seen_in;
    seen_in.insert(std::lower_bound(seen_in.begin(), seen_in.end(), id), id);
  }
}

}  // namespace edgeslam
