#include "pipeline/map_joining.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "edgeslam/input_error.h"
#include "map/map_check.h"
#include "mapping/local_adjustment.h"
#include "places/known_frame.h"
#include "places/loop_closing.h"
#include "places/relocalisation.h"
#include "places/world_alignment.h"
#include "tracking/measured_noise.h"

namespace edgeslam {
namespace {

// What the numbers of an added map begin with.
struct Offsets {
  KeyframeId keyframe = 0;
  int world = 0;
  PointId point = 0;
  LineId line = 0;
};

PointId largestPoint(const Map& map) {
  const PointId mapped = map.points.empty() ? 0 : map.points.rbegin()->first + 1;
  return std::max(mapped, firstFreePoint(map));
}

Offsets numbersAfter(const Map& map, const Map& added) {
  const Offsets offsets{map.keyframes.back().id + 1, worldsOf(map).back() + 1, largestPoint(map), map.next_line};
  if (added.keyframes.back().id > largest_keyframe_id - offsets.keyframe ||
      worldsOf(added).back() > largest_keyframe_id - offsets.world ||
      largestPoint(added) > largest_count - offsets.point || added.next_line > largest_count - offsets.line) {
    throw InputError("together the maps have larger numbers than a map can have");
  }
  return offsets;
}

Map renumbered(const Map& added, const Offsets& offsets) {
  Map map;
  for (Keyframe keyframe : added.keyframes) {
    keyframe.id += offsets.keyframe;
    keyframe.world += offsets.world;
    std::vector<PointObservation> observations(keyframe.observations.begin(), keyframe.observations.end());
    for (PointObservation& observation : observations) observation.point += offsets.point;
    keyframe.observations = std::move(observations);
    for (SeenEdge& edge : keyframe.straight_edges) edge.line += edge.line >= 0 ? offsets.line : 0;
    map.keyframes.push_back(std::move(keyframe));
  }
  for (const auto& entry : added.points) {
    MapPoint point = entry.second;
    point.id += offsets.point;
    point.host += offsets.keyframe;
    point.chain_keyframe = std::min(point.chain_keyframe + offsets.keyframe, largest_keyframe_id);
    for (KeyframeId& id : point.seen_in) id += offsets.keyframe;
    map.points.emplace_hint(map.points.end(), point.id, std::move(point));
  }
  for (const auto& entry : added.lines) {
    MapLine line = entry.second;
    line.id += offsets.line;
    line.host += offsets.keyframe;
    for (KeyframeId& id : line.seen_in) id += offsets.keyframe;
    map.lines.emplace_hint(map.lines.end(), line.id, std::move(line));
  }
  map.next_line = offsets.line + added.next_line;
  for (const auto& [world, alignment] : added.inertia) map.inertia.emplace(world + offsets.world, alignment);
  for (const auto& [world, scale] : added.wheels) map.wheels.emplace(world + offsets.world, scale);
  return map;
}

Map together(const Map& map, const Map& renumbered) {
  Map both = map;
  for (const Keyframe& keyframe : renumbered.keyframes) both.keyframes.push_back(keyframe);
  both.points.insert(renumbered.points.begin(), renumbered.points.end());
  both.lines.insert(renumbered.lines.begin(), renumbered.lines.end());
  both.next_line = renumbered.next_line;
  both.inertia.insert(renumbered.inertia.begin(), renumbered.inertia.end());
  both.wheels.insert(renumbered.wheels.begin(), renumbered.wheels.end());
  return both;
}

// A keyframe of the one map, found in the other.
struct Sighting {
  KeyframeId keyframe = -1;
  int world = -1, other_world = -1;
  Pose world_T_camera, other_T_camera;
  double other_distance = 1;  // of what it sees, in the other's unit
  std::vector<MatchedPoint> points;
};

std::vector<Sighting> sightings(const Camera& camera, const Settings& settings, const Map& map, const Map& other) {
  const ImageReading reading{settings.edges, settings.points.accuracy};
  Relocalisation relocalisation(camera, reading.accuracy, settings.relocalisation);
  relocalisation.update(other);
  std::vector<Sighting> found;
  for (const Keyframe& keyframe : map.keyframes) {
    if (!keyframe.images) continue;
    const std::shared_ptr<const FrameImages> images = keyframe.images.get();
    const EdgeMap edges = detectEdges(images->pyramid.levels[0], reading.edges, camera.mask.get());
    const double noise_factor = noiseFactorOf(keyframe, reading.accuracy);
    RelocalisationResult result = relocalisation.relocalise(other, *images, edges, std::nullopt, noise_factor);
    if (!result.found) continue;
    found.push_back({keyframe.id, keyframe.world, other.keyframes[result.keyframe].world, keyframe.world_T_camera,
                     result.world_T_camera, result.evidence.median_distance, std::move(result.matches)});
  }
  return found;
}

// Of the later world in the earlier one.
FoundInBoth inBoth(const Sighting& sighting) {
  if (sighting.world > sighting.other_world) {
    return {sighting.world_T_camera, sighting.other_T_camera, sighting.other_distance};
  }
  return {sighting.other_T_camera, sighting.world_T_camera, sighting.other_distance};
}

LoopCorrection correctionOf(const Camera& camera, const Map& both, const std::vector<Sighting>& found,
                            const WorldAlignment& alignment, int from, int to) {
  LoopCorrection correction;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // in the middle of the cameras that agree
  for (const std::size_t i : alignment.agreeing) {
    place += inBoth(found[i]).from_T_camera.translation / static_cast<double>(alignment.agreeing.size());
  }
  correction.join =
      WorldJoin{from, to, putRight(knownFrame(both, from), knownFrame(both, to), alignment.to_S_from, place)};
  for (const std::size_t i : alignment.agreeing) {
    for (const MatchedPoint& match : found[i].points) {
      PointObservation observation;
      observation.point = match.point;
      observation.measurement = match.measurement;
      observation.bearing = bearing(camera, match.measurement.pixel);
      observation.corner = both.points.at(match.point).corner;
      correction.observations.push_back({found[i].keyframe, observation});
    }
  }
  return correction;
}

// Of the pairs of worlds the one with most keyframes that agree; the world that both are then, or -1.
int joinBySightings(const Camera& camera, const std::vector<Sighting>& found, Map& both, MapJoining& joining) {
  std::map<std::pair<int, int>, std::vector<Sighting>> by_worlds;
  for (const Sighting& sighting : found) {
    by_worlds[std::minmax(sighting.world, sighting.other_world)].push_back(sighting);
  }
  std::optional<LoopCorrection> best;
  for (const auto& [worlds, its] : by_worlds) {
    std::vector<FoundInBoth> cameras;
    for (const Sighting& sighting : its) cameras.push_back(inBoth(sighting));
    std::size_t agreeing = 0;
    const std::optional<WorldAlignment> alignment = alignWorlds(cameras, WorldAlignmentOptions(), agreeing);
    const bool cannot_be = alignment && !contradiction(knownFrame(both, worlds.second), knownFrame(both, worlds.first),
                                                       alignment->to_S_from, KnownFrameOptions())
                                             .empty();
    if (cannot_be) continue;
    if (agreeing > joining.agreeing && alignment) {
      best = correctionOf(camera, both, its, *alignment, worlds.second, worlds.first);
    }
    joining.agreeing = std::max(joining.agreeing, agreeing);
  }
  if (!best) return -1;
  applyCorrection(*best, both);
  return best->join->to;
}

// The map as it was when this keyframe was its latest. Lines say nothing to places.
Map asOf(const Map& map, KeyframeId latest) {
  Map before;
  before.inertia = map.inertia;
  before.wheels = map.wheels;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.id > latest) break;
    before.keyframes.push_back(keyframe);
  }
  for (const auto& [id, point] : map.points) {
    if (point.host > latest) continue;
    MapPoint& seen = before.points.emplace_hint(before.points.end(), id, point)->second;
    seen.seen_in.erase(std::upper_bound(seen.seen_in.begin(), seen.seen_in.end(), latest), seen.seen_in.end());
  }
  return before;
}

void note(const LoopOutcome& outcome, int& most_inliers, MapJoining& joining) {
  for (const JudgedLoop& judged : outcome.considered) {
    ++joining.alike;
    if (judged.accepted || judged.verification.inliers < most_inliers) continue;
    most_inliers = judged.verification.inliers;
    joining.nearest_loop = judged.reason;
  }
  joining.loops += outcome.correction ? 1 : 0;
}

// The world that both are then, or -1.
int joinByLoops(const Camera& camera, const Settings& settings, const Map& added, const Offsets& offsets, Map& both,
                MapJoining& joining) {
  LoopClosing loop_closing(camera, {settings.edges, settings.points.accuracy}, settings.loops);
  int common = -1, most_inliers = 0;
  for (const Keyframe& keyframe : added.keyframes) {
    const LoopOutcome outcome = loop_closing.addKeyframe(asOf(both, keyframe.id));
    note(outcome, most_inliers, joining);
    if (!outcome.correction) continue;
    if (const std::optional<WorldJoin>& join = outcome.correction->join) {
      const bool is_of_both = join->to < offsets.world && join->from >= offsets.world;
      if (is_of_both || join->from == common) common = join->to;
    }
    applyCorrection(*outcome.correction, both);
  }
  return common;
}

void adjustWorld(const Camera& camera, const Settings& settings, int world, Map& map) {
  LocalAdjustmentOptions adjustment = settings.mapping.local_adjustment;
  adjustment.bundle = settings.mapping.global_adjustment.bundle;
  adjustment.bundle.iterations = settings.places.iterations_after_loop;
  const std::vector<KeyframeId> keyframes = keyframesOf(map, world);
  if (keyframes.size() > 1) adjustKeyframes(camera, adjustment, keyframes, {}, map);
}

}  // namespace

MapJoining joinMap(const Camera& camera, const Settings& settings, const Map& added, Map& map) {
  const Offsets offsets = numbersAfter(map, added);
  const Map second = renumbered(added, offsets);
  MapJoining joining;
  joining.keyframes = static_cast<int>(map.keyframes.size() + second.keyframes.size());
  std::vector<Sighting> found = sightings(camera, settings, second, map);
  for (Sighting& sighting : sightings(camera, settings, map, second)) found.push_back(std::move(sighting));
  joining.found = static_cast<int>(found.size());

  Map both = together(map, second);
  int common = joinBySightings(camera, found, both, joining);
  if (common < 0) common = joinByLoops(camera, settings, second, offsets, both, joining);
  joining.is_joined = common >= 0;
  if (!joining.is_joined) return joining;
  adjustWorld(camera, settings, common, both);
  map = std::move(both);
  return joining;
}

}  // namespace edgeslam
