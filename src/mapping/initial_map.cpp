#include "mapping/initial_map.h"

#include <algorithm>
#include <optional>

#include "map/worlds.h"

namespace edgeslam {
namespace {

void addKeyframe(const TrackedFrame& frame, KeyframeId id, const Pose& pose, const char* reason, Map& map) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.frame_index = frame.frame_index;
  keyframe.time_ns = frame.time_ns;
  keyframe.world_T_camera = pose;
  keyframe.twist = frame.twist;
  keyframe.observations = frame.observations;
  keyframe.straight_edges = frame.straight_edges;
  keyframe.images = frame.images;
  keyframe.reason = reason;
  keyframe.wheels = frame.wheels;
  map.keyframes.push_back(std::move(keyframe));
}

// Since the start began; none where it was not measured all the way.
std::optional<PreintegratedMotion> motionSinceStart(const TrackedFrame& frame) {
  if (frame.kind == FrameKind::first) return PreintegratedMotion();
  return frame.inertia.from >= 0 ? std::optional<PreintegratedMotion>(frame.inertia.motion) : std::nullopt;
}

void linkToLatest(const TrackedFrame& before, const TrackedFrame& frame, Map& map) {
  const std::optional<PreintegratedMotion> first = motionSinceStart(before), whole = motionSinceStart(frame);
  if (!first || !whole) return;
  Keyframe& latest = map.keyframes.back();
  latest.inertia = {keyframeBefore(map, latest.id), remainder(*whole, *first)};
}

}  // namespace

Map initialMap(const Camera& camera, const InitialFrames& frames, const InitialStructure& structure,
               double largest_depth_sigma) {
  Map map;
  const KeyframeId first_id = frames.first.keyframe;
  KeyframeId id = first_id;
  addKeyframe(frames.first, id, Pose(), "first", map);
  const TrackedFrame* before = &frames.first;
  for (std::size_t k = 0; k < structure.frames.size(); ++k) {
    const TrackedFrame& frame = frames.since[structure.frames[k]];
    addKeyframe(frame, ++id, structure.first_T_camera[k], "initialisation", map);
    linkToLatest(*before, frame, map);
    before = &frame;
  }
  for (std::size_t i = 0; i < frames.first.observations.size(); ++i) {
    if (!structure.isKnown(i, largest_depth_sigma)) continue;
    const PointObservation& first = frames.first.observations[i];
    MapPoint point;
    point.id = first.point;
    point.host = point.chain_keyframe = first_id;
    setPlace(rayOrigin(camera, frames.first, first), first.bearing, structure.inverse_depths[i],
             structure.depth_sigmas[i], point);
    point.corner = first.corner;
    point.chain = first.chain;
    point.order = first.order;
    for (const Keyframe& keyframe : map.keyframes) {
      if (keyframe.id > first_id && findObservation(keyframe, point.id)) point.seen_in.push_back(keyframe.id);
    }
    if (!point.seen_in.empty()) map.points.emplace(point.id, point);
  }
  return map;
}

std::vector<std::pair<std::int64_t, Pose>> posesOfInitialFrames(const Camera& camera, const InitialFrames& frames,
                                                                const InitialStructure& structure) {
  std::vector<std::pair<std::int64_t, Pose>> poses{{frames.first.frame_index, Pose()}};
  // Backwards from the last frame, whose pose is known: each starts from its successor.
  Pose pose = structure.first_T_camera.empty() ? Pose() : structure.first_T_camera.back();
  for (std::size_t frame = frames.since.size(); frame-- > 0;) {
    const std::optional<Pose> located =
        locateAgainst(camera, frames.first, structure.inverse_depths, frames.since[frame], pose);
    if (!located) break;
    pose = *located;
    poses.emplace_back(frames.since[frame].frame_index, pose);
  }
  std::sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return poses;
}

void tellMotion(const InitialFrames& frames, const std::vector<std::pair<std::int64_t, Pose>>& poses, Map& map) {
  const auto secondsUntil = [&](std::int64_t frame_index) {
    const auto frame = std::find_if(frames.since.begin(), frames.since.end(),
                                    [&](const TrackedFrame& f) { return f.frame_index == frame_index; });
    return frame == frames.since.end() ? 0.0 : 1e-9 * static_cast<double>(frame->time_ns - frames.first.time_ns);
  };
  for (Keyframe& keyframe : map.keyframes) {
    const auto at =
        std::find_if(poses.begin(), poses.end(), [&](const auto& pose) { return pose.first == keyframe.frame_index; });
    if (at == poses.end()) continue;
    const auto before = at == poses.begin() ? at : at - 1, after = at + 1 == poses.end() ? at : at + 1;
    const double seconds = secondsUntil(after->first) - secondsUntil(before->first);
    if (seconds > 0) keyframe.twist = twistBetween(before->second, after->second, seconds);
  }
}

}  // namespace edgeslam
