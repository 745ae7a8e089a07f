// What tracking and mapping give to each other: the first frame of a map, keyframes, lost frames; views of the map.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/tracker.h"

namespace edgeslam {
namespace {

// How the world moved from one view to the next, by the latest keyframe that both know.
Pose newWorldTOldWorld(const MapView& old_view, const MapView& new_view) {
  for (std::size_t place = new_view.keyframes.size(); place-- > 0;) {
    const ViewKeyframe& keyframe = new_view.keyframes.atPlace(place);
    const ViewKeyframe* before = old_view.keyframes.find(keyframe.id);
    if (before) return keyframe.world_T_camera * before->world_T_camera.inverse();
  }
  return Pose();
}

Track trackOf(const ChosenPoint& chosen, bool weigh_edges) {
  Track track;
  track.pixel = track.keyframe_pixel = track.last_keyframe_pixel = chosen.pixel;
  track.normal = chosen.normal;
  track.corner = chosen.corner;
  track.sigma_normal = chosen.sigma_normal;
  track.sigma_tangent = weigh_edges ? chosen.sigma_tangent : chosen.sigma_normal;
  track.chain = chosen.chain;
  return track;
}

Track trackOf(const FoundAgain& found) {
  Track track;
  track.id = found.point;
  track.pixel = track.last_keyframe_pixel = found.measurement.pixel.cast<float>();
  track.normal = found.measurement.normal.cast<float>();
  track.corner = found.corner;
  track.sigma_normal = static_cast<float>(found.measurement.sigma_normal);
  track.sigma_tangent = static_cast<float>(found.measurement.sigma_tangent);
  return track;
}

}  // namespace

void Tracker::startMap(const char* reason, bool mapping_busy, StageClock& clock, TrackingOutcome& outcome) {
  if (mapping_busy) {
    outcome.reason = "mapping is behind";
    last_.images.reset();
    return;
  }
  next_keyframe_ = 0;
  frame_.tracks.clear();
  frame_.world_T_camera = Pose();
  frame_.inlier_count = 0;
  choosePointsIn(frame_, next_keyframe_);
  outcome.tracked_points = static_cast<int>(frame_.tracks.size());
  clock.finished(Stage::choice_of_points);
  if (outcome.tracked_points < options_.fewest_tracks) {
    outcome.reason = "too few points on edges (";
    outcome.reason += std::to_string(outcome.tracked_points);
    outcome.reason += ")";
    last_.images.reset();
    return;
  }
  outcome.reason = reason;
  outcome.reference = 0;
  outcome.tells_mapping = true;
  describe(frame_, next_keyframe_++, "first", outcome.for_mapping);
  makeFlatView(outcome.for_mapping, view_);
  tracks_at_start_ = frame_.tracks.size();
  last_T_next_ = Pose();
  interval_ns_ = 0;
  std::swap(last_, frame_);
}

KeyframeDecision Tracker::judge() const {
  KeyframeEvidence evidence;
  evidence.rotation_deg =
      rotationAngle(view_.keyframes.back().world_T_camera.rotation, frame_.world_T_camera.rotation) * 180.0 / M_PI;
  for (const Track& track : frame_.tracks)
    evidence.mean_displacement_px += (track.pixel - track.last_keyframe_pixel).norm();
  evidence.mean_displacement_px /= std::max<double>(1, static_cast<double>(frame_.tracks.size()));
  evidence.tracks = static_cast<int>(frame_.tracks.size());
  evidence.average_tracks = average_tracks_;
  evidence.mapped = frame_.inlier_count;
  evidence.mapped_at_keyframe = mapped_at_keyframe_;
  evidence.seconds = static_cast<double>(frame_.images->time_ns - keyframe_time_ns_) * 1e-9;
  evidence.frames = frames_since_keyframe_;
  return selectKeyframe(evidence, camera_.width, options_.keyframes);
}

void Tracker::becomeKeyframe(TrackedState& frame, const char* reason, TrackingOutcome& outcome) {
  reuseMap(frame);
  for (Track& track : frame.tracks) {
    track.keyframe = next_keyframe_;
    track.keyframe_images = frame.images;
    track.keyframe_pixel = track.last_keyframe_pixel = track.pixel;
  }
  choosePointsIn(frame, next_keyframe_);
  outcome.tells_mapping = true;
  describe(frame, next_keyframe_++, reason, outcome.for_mapping);
  // Until mapping answers, the keyframe stands where tracking saw it.
  view_.keyframes.push_back({next_keyframe_ - 1, frame.world_T_camera, nullptr});
  keyframe_time_ns_ = frame.images->time_ns;
  frames_since_keyframe_ = 0;
  mapped_at_keyframe_ = 0;
}

void Tracker::choosePointsIn(TrackedState& frame, KeyframeId keyframe) {
  occupied_.clear();
  for (const Track& track : frame.tracks) occupied_.push_back(track.pixel);
  choosePoints(frame.images->pyramid.levels[0], *frame.edges, occupied_, points_, choice_workspace_, chosen_);
  for (const ChosenPoint& chosen : chosen_) {
    Track& track = frame.tracks.emplace_back(trackOf(chosen, options_.points.weigh_edges));
    track.id = next_point_++;
    track.order = nearestEdgePoint(*frame.edges, chosen.pixel, chosen.normal, 1.0f, -1.0f);
    track.keyframe = keyframe;
    track.keyframe_images = frame.images;
  }
}

void Tracker::describe(const TrackedState& frame, KeyframeId keyframe, const char* reason,
                       TrackedFrame& description) const {
  description.frame_index = frame.images->frame_index;
  description.time_ns = frame.images->time_ns;
  description.world_T_camera = frame.world_T_camera;
  description.keyframe = keyframe;
  description.reason = reason;
  description.images = keyframe >= 0 ? frame.images : nullptr;
  description.observations.clear();
  for (const Track& track : frame.tracks) {
    const Measurement measurement = measurementOf(track);
    description.observations.push_back(
        {track.id, measurement, bearing(camera_, measurement.pixel), track.corner, track.chain, track.order});
  }
}

void Tracker::keepLostFrame(TrackedFrame& description) {
  std::swap(kept_, lost_);
  lost_.images.reset();
  describe(kept_, next_keyframe_++, "recovery", description);
}

void Tracker::resume(MapView& view, const Pose& world_T_camera, const Matrix6d& covariance,
                     const std::vector<FoundAgain>& points) {
  std::swap(last_, kept_);
  kept_.images.reset();
  if (!points.empty()) last_.tracks.clear();
  for (const FoundAgain& found : points) last_.tracks.push_back(trackOf(found));
  std::sort(last_.tracks.begin(), last_.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
  last_.world_T_camera = world_T_camera;
  last_.covariance = covariance;
  last_.inlier_count = 0;
  std::swap(view_, view);
  next_keyframe_ = std::max(next_keyframe_, view_.keyframes.back().id + 1);
  last_T_next_ = Pose();
  interval_ns_ = 0;
  lost_since_ns_ = -1;
  average_tracks_ = 0;
  askForKeyframe();
}

void Tracker::startLost(const MapView& view, PointId first_free_point) {
  view_ = view;
  next_point_ = first_free_point;
  next_keyframe_ = view.keyframes.back().id + 1;
}

void Tracker::adopt(MapView& view) {
  if (view.version <= view_.version && view.origin_frame == view_.origin_frame) return;
  if (!last_.images || view.origin_frame != view_.origin_frame) return;
  const bool first = view.initialised && !view_.initialised;
  // What mapping has not seen yet keeps its place relative to the latest keyframe known to both.
  const Pose new_T_old = newWorldTOldWorld(view_, view);
  const KeyframeId latest = view.keyframes.back().id;
  for (const ViewKeyframe& keyframe : view_.keyframes) {
    if (keyframe.id > latest) view.keyframes.push_back({keyframe.id, new_T_old * keyframe.world_T_camera, nullptr});
  }
  std::swap(view_, view);
  const Pose moved = new_T_old * last_.world_T_camera;
  if (first) {
    next_keyframe_ = view_.keyframes.back().id + 1;
    askForKeyframe();
  }
  scratch_.release();
  const FramePose again = estimatePose(camera_, view_, last_.tracks, moved, options_.pose, &scratch_);
  last_.world_T_camera = again.result.converged ? again.result.world_T_camera : moved;
}

// With fresh points, as soon as the next frame may become one.
void Tracker::askForKeyframe() {
  keyframe_time_ns_ = last_.images->time_ns;
  frames_since_keyframe_ = options_.keyframes.least_frames_apart;
  mapped_at_keyframe_ = options_.keyframes.fewest_mapped * 2;
}

}  // namespace edgeslam
