#include "pipeline/places_worker.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

std::vector<TimedPose> keyframePath(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::vector<TimedPose> path;
  for (const KeyframeId id : keyframes) path.push_back({map.keyframes[id].time_ns, map.keyframes[id].world_T_camera});
  return path;
}

// What was looked at takes little memory again, but for what tracking compares with.
void packImages(const Map& map) {
  for (const Keyframe& keyframe : map.keyframes) keyframe.images.pack();
}

}  // namespace

Correction PlacesWorker::work(const Snapshot& snapshot) {
  Correction correction = correctionOf(snapshot);
  packImages(*snapshot.map);
  return correction;
}

Correction PlacesWorker::correctionOf(const Snapshot& snapshot) {
  Correction correction;
  correction.number = snapshot.number;
  const Map& before = *snapshot.map;
  camera_ = withFound(calibrated_, before.found);
  loop_closing_.setCamera(camera_);
  correction.found = before.found;
  if (before.keyframes.front().frame_index != origin_frame_) {
    origin_frame_ = before.keyframes.front().frame_index;
    // Where a saved map is continued, the camera is in its old parts from the start.
    last_met_ = last_shared_out_ = last_global_ = before.keyframes.back().id;
    last_global_ns_ = before.keyframes.back().time_ns;
  }
  Map map = before;
  const bool closed = settings_.loops.enabled && closeLoop(map, correction);
  const bool due = globalAdjustmentDue(map);
  bool adjusted = false;
  if (closed || due) {
    last_global_ = map.keyframes.back().id;
    last_global_ns_ = map.keyframes.back().time_ns;
    GlobalAdjustmentOptions adjustment = settings_.mapping.global_adjustment;
    if (closed) adjustment.bundle.iterations = settings_.places.iterations_after_loop;
    adjusted = adjustGlobally(camera_, adjustment, settings_.mapping.local_adjustment, map, &interrupted_);
  }
  if (!closed && !adjusted) return correction;
  if (correction.loop) {
    const std::vector<KeyframeId> path = keyframesOf(before, before.keyframes.back().world);
    correction.loop->before = keyframePath(before, path);
    correction.loop->after = keyframePath(map, path);
    correction.loop->frame_index = snapshot.frame_index;
    correction.loop->keyframe = map.keyframes.back().id;
  }
  correction.change = changeOf(before, map, correction.change.join);
  return correction;
}

// True where drift is to be shared out: by what a place looks like, or by its points, which map reuse found again.
bool PlacesWorker::closeLoop(Map& map, Correction& correction) {
  const LoopOutcome outcome = loop_closing_.addKeyframe(map);
  for (const JudgedLoop& judged : outcome.considered) {
    correction.events.push_back("loop of keyframe " + std::to_string(outcome.current) + " to keyframe " +
                                std::to_string(judged.keyframe) + (judged.accepted ? " closed: " : " refused: ") +
                                judged.reason);
  }
  const Meeting meeting = meetOldPart(map);
  if (outcome.correction) {
    applyCorrection(*outcome.correction, map);
    if (const std::optional<WorldJoin>& join = outcome.correction->join) {
      correction.change.join = join;
      correction.events.push_back("map " + std::to_string(join->from) + " is part of map " + std::to_string(join->to) +
                                  ", and joined to it");
    }
    correction.loop.emplace().how = "by its looks";
  } else if (meeting == Meeting::first) {
    correction.events.emplace_back("an old part of the map is met again by its points");
    correction.loop.emplace().how = "by its points";
  }
  return correction.loop.has_value() || meeting == Meeting::longer;
}

// The latest keyframe sees points of a part of the map left long ago: `first` where none of the keyframes just before
// it did, `longer` where they did and drift has gathered since it was shared out.
PlacesWorker::Meeting PlacesWorker::meetOldPart(const Map& map) {
  const PlacesOptions& options = settings_.places;
  const KeyframeId latest = map.keyframes.back().id;
  const std::vector<int> shared = sharedPoints(map, latest);
  int old_points = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.id + options.old_keyframes >= latest) break;
    old_points = std::max(old_points, shared[static_cast<std::size_t>(keyframe.id)]);
  }
  if (old_points < options.old_points) return Meeting::none;
  const auto longAgo = [&](KeyframeId id) { return id < 0 || latest - id > options.old_keyframes / 4; };
  const bool first = longAgo(last_met_);
  last_met_ = latest;
  if (!longAgo(last_shared_out_)) return Meeting::none;
  last_shared_out_ = latest;
  return first ? Meeting::first : Meeting::longer;
}

bool PlacesWorker::globalAdjustmentDue(const Map& map) const {
  const Keyframe& latest = map.keyframes.back();
  const double seconds = std::abs(static_cast<double>(latest.time_ns - last_global_ns_)) * 1e-9;
  return latest.id - last_global_ >= settings_.places.global_interval_keyframes ||
         seconds >= settings_.places.global_interval_s;
}

}  // namespace edgeslam
