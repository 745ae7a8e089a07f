#include "tracking/tracker.h"

#include <algorithm>
#include <cmath>

#include "tracking/measurement_accuracy.h"
#include "tracking/point_following.h"

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

}  // namespace

TrackingOutcome Tracker::track(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey) {
  TrackingOutcome outcome;
  StageClock clock(outcome.times);
  lost_ = TrackedState();
  TrackedState frame = prepare(frame_index, time_ns, grey, clock);
  latest_images_ = frame.images;
  if (isBlurred(blur_gate_, sharpness(grey, frame.edges), options_.blur_gate) && last_.images) {
    const StageTimes times = outcome.times;
    outcome = skip(time_ns, "blurred image");
    if (lost_since_ns_ < 0) lost_since_ns_ = time_ns;
    outcome.times = times;
    return outcome;
  }
  if (!last_.images && !view_.initialised) {
    startMap(std::move(frame), outcome);
    clock.finished(Stage::choice_of_points);
    return outcome;
  }

  const bool given_up = !last_.images || (lost_since_ns_ >= 0 && static_cast<double>(time_ns - lost_since_ns_) * 1e-9 >
                                                                     options_.regain_seconds);
  bool located = !given_up && followAndLocate(last_, frame, clock);
  if (!view_.initialised && (!located || static_cast<double>(frame.tracks.size()) <
                                             options_.restart_share * static_cast<double>(tracks_at_start_))) {
    startMap(std::move(frame), outcome);
    outcome.reason = "starting anew: too few of the first frame's points are left";
    clock.finished(Stage::choice_of_points);
    return outcome;
  }
  if (view_.initialised && located) {
    const KeyframeDecision decision = judge(frame);
    if (decision.choice == KeyframeChoice::previous_frame) {
      becomeKeyframe(last_, decision.reason, outcome);
      clock.finished(Stage::choice_of_points);
      located = followAndLocate(last_, frame, clock);
    } else if (decision.choice == KeyframeChoice::current_frame) {
      becomeKeyframe(frame, decision.reason, outcome);
      clock.finished(Stage::choice_of_points);
    }
  }
  if (located && view_.initialised &&
      frames_since_keyframe_ % options_.map_reuse.interval == options_.map_reuse.interval - 1) {
    reuseMapPoints(camera_, view_, frame.images, frame.edges, frame.world_T_camera,
                   static_cast<std::size_t>(options_.points.count), options_.map_reuse, frame.tracks);
    clock.finished(Stage::map_reuse);
  }
  if (!located) {
    TrackingOutcome lost = skip(time_ns, "map points not found again");
    lost.state = FrameState::lost;
    lost.times = outcome.times;
    lost.for_mapping = std::move(outcome.for_mapping);
    if (lost_since_ns_ < 0) lost_since_ns_ = time_ns;
    lost_ = std::move(frame);
    return lost;
  }

  outcome.state = view_.initialised ? FrameState::tracking : FrameState::initialising;
  outcome.reason = view_.initialised ? "" : view_.waiting_for;
  outcome.world_T_camera = frame.world_T_camera;
  outcome.covariance = frame.pose.covariance;
  outcome.reference = view_.keyframes.back().id;
  outcome.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * frame.world_T_camera;
  outcome.tracked_points = static_cast<int>(frame.tracks.size());
  outcome.mapped_points = frame.pose.inlier_count;
  if (!view_.initialised) outcome.for_mapping.push_back(describe(frame, -1, ""));
  remember(std::move(frame));
  return outcome;
}

Tracker::TrackedState Tracker::prepare(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey,
                                       StageClock& clock) const {
  TrackedState frame;
  auto images = std::make_shared<FrameImages>();
  images->frame_index = frame_index;
  images->time_ns = time_ns;
  images->pyramid = buildPyramid(grey, std::max(options_.flow.levels, 6));
  clock.finished(Stage::pyramid);
  frame.edges = detectEdges(images->pyramid.levels[0], options_.edges);
  clock.finished(Stage::edges);
  frame.images = std::move(images);
  return frame;
}

void Tracker::startMap(TrackedState frame, TrackingOutcome& outcome) {
  outcome.state = FrameState::initialising;
  next_keyframe_ = 0;
  frame.tracks.clear();
  frame.world_T_camera = Pose();
  choosePointsIn(frame, next_keyframe_);
  outcome.tracked_points = static_cast<int>(frame.tracks.size());
  if (static_cast<int>(frame.tracks.size()) < options_.fewest_tracks) {
    outcome.reason = "too few points on edges (" + std::to_string(frame.tracks.size()) + ")";
    last_ = TrackedState();
    return;
  }
  outcome.reason = "first frame of the map";
  outcome.for_mapping.push_back(describe(frame, next_keyframe_++, "first"));
  outcome.reference = 0;
  view_ = flatView(outcome.for_mapping.back());
  tracks_at_start_ = frame.tracks.size();
  last_T_next_ = Pose();
  interval_ns_ = 0;
  last_ = std::move(frame);
}

bool Tracker::followAndLocate(const TrackedState& from, TrackedState& frame, StageClock& clock) const {
  const double scene_depth = medianDepth(from.tracks, view_, from.world_T_camera, 1.0);
  const Pose predicted = alignImages(from, frame, predictPose(frame.images->time_ns), scene_depth);
  clock.finished(Stage::alignment);
  const auto predictions = predictPixels(camera_, from.tracks, view_, from.world_T_camera, predicted, scene_depth);
  const auto matches = followPoints(*from.images, *frame.images, from.tracks, predictions, options_.flow);
  frame.tracks = filterTracks(*from.images, *frame.images, frame.edges, from.tracks, matches, options_.flow);
  clock.finished(Stage::flow);

  FramePose estimate = estimatePose(camera_, view_, frame.tracks, predicted, options_.pose);
  if (!estimate.result.converged) return false;
  clock.finished(Stage::pose);
  refineTracks(camera_, view_, *frame.images, estimate.result.world_T_camera, scene_depth, options_.refinement,
               frame.tracks);
  clock.finished(Stage::refinement);
  estimate = estimatePose(camera_, view_, frame.tracks, estimate.result.world_T_camera, options_.pose);
  const auto in_view = static_cast<double>(estimate.track_of_observation.size());
  // A flat map fits a scene with depth only here and there: before the map stands no share of inliers is asked for.
  double fewest_inliers = 0;
  if (view_.initialised) {
    fewest_inliers =
        std::max(options_.least_inlier_share * in_view, options_.least_points_share * from.pose.inlier_count);
  }
  if (view_.initialised && lost_since_ns_ >= 0) {
    const double most_of_them =
        std::max(options_.regain_inlier_share * in_view, options_.regain_fewest_points_share * from.pose.inlier_count);
    const double as_many_as_before = options_.regain_points_share * from.pose.inlier_count;
    fewest_inliers = std::max(fewest_inliers, std::min(most_of_them, as_many_as_before));
  }
  if (!estimate.result.converged || estimate.result.inlier_count < fewest_inliers) return false;
  frame.pose = estimate.result;
  frame.world_T_camera = estimate.result.world_T_camera;

  for (std::size_t i = 0; i < estimate.track_of_observation.size(); ++i) {
    Track& track = frame.tracks[static_cast<std::size_t>(estimate.track_of_observation[i])];
    track.outlier_frames = estimate.result.inliers[i] ? 0 : track.outlier_frames + 1;
  }
  frame.tracks.erase(
      std::remove_if(frame.tracks.begin(), frame.tracks.end(),
                     [&](const Track& t) { return view_.initialised && t.outlier_frames >= options_.outlier_frames; }),
      frame.tracks.end());
  lockAlongEdges(camera_, view_, frame.world_T_camera, options_.edge_lock, frame.tracks);
  const cv::Mat& grey = frame.images->pyramid.levels[0];
  for (Track& track : frame.tracks) updateAccuracy(grey, options_.points, track);
  clock.finished(Stage::pose);
  return true;
}

// The motion since the last frame from the images as a whole: first its rotation, then all of it by the tracks'
// patches.
Pose Tracker::alignImages(const TrackedState& from, const TrackedState& to, const Pose& world_T_predicted,
                          double scene_depth) const {
  const Pose by_velocity = world_T_predicted.inverse() * from.world_T_camera;
  const Eigen::Quaterniond turned =
      alignRotation(camera_, rotation_grids_, from.images->pyramid, to.images->pyramid, by_velocity.rotation);
  const Pose by_rotation{turned, by_velocity.translation};
  const Pose from_T_world = from.world_T_camera.inverse();
  std::vector<AlignmentPoint> points;
  points.reserve(from.tracks.size());
  for (const Track& track : from.tracks) {
    const ViewPoint* point = findPoint(view_, track.id);
    const double depth = point ? (from_T_world * worldPosition(view_, *point)).norm() : scene_depth;
    points.push_back({track.pixel, bearing(camera_, track.pixel.cast<double>()) * depth});
  }
  const Pose to_T_from = alignSparsely(camera_, from.images->pyramid, to.images->pyramid, points, by_rotation,
                                       by_velocity, options_.alignment);
  return from.world_T_camera * to_T_from.inverse();
}

KeyframeDecision Tracker::judge(const TrackedState& frame) const {
  KeyframeEvidence evidence;
  evidence.rotation_deg =
      rotationAngle(view_.keyframes.back().world_T_camera.rotation, frame.world_T_camera.rotation) * 180.0 / M_PI;
  for (const Track& track : frame.tracks)
    evidence.mean_displacement_px += (track.pixel - track.last_keyframe_pixel).norm();
  evidence.mean_displacement_px /= std::max<double>(1, static_cast<double>(frame.tracks.size()));
  evidence.tracks = static_cast<int>(frame.tracks.size());
  evidence.average_tracks = average_tracks_;
  evidence.mapped = frame.pose.inlier_count;
  evidence.mapped_at_keyframe = mapped_at_keyframe_;
  evidence.seconds = static_cast<double>(frame.images->time_ns - keyframe_time_ns_) * 1e-9;
  evidence.frames = frames_since_keyframe_;
  return selectKeyframe(evidence, camera_.width, options_.keyframes);
}

void Tracker::becomeKeyframe(TrackedState& frame, const char* reason, TrackingOutcome& outcome) {
  reuseMapPoints(camera_, view_, frame.images, frame.edges, frame.world_T_camera,
                 static_cast<std::size_t>(options_.points.count), options_.map_reuse, frame.tracks);
  for (Track& track : frame.tracks) {
    track.keyframe = next_keyframe_;
    track.keyframe_images = frame.images;
    track.keyframe_pixel = track.last_keyframe_pixel = track.pixel;
  }
  choosePointsIn(frame, next_keyframe_);
  outcome.for_mapping.push_back(describe(frame, next_keyframe_++, reason));
  // Until mapping answers, the keyframe stands where tracking saw it.
  view_.keyframes.push_back({next_keyframe_ - 1, frame.world_T_camera, nullptr});
  keyframe_time_ns_ = frame.images->time_ns;
  frames_since_keyframe_ = 0;
  mapped_at_keyframe_ = 0;
}

void Tracker::choosePointsIn(TrackedState& frame, KeyframeId keyframe) {
  std::vector<Eigen::Vector2f> occupied;
  for (const Track& track : frame.tracks) occupied.push_back(track.pixel);
  for (const ChosenPoint& chosen :
       choosePoints(frame.images->pyramid.levels[0], frame.edges, occupied, options_.points)) {
    Track track;
    track.id = next_point_++;
    track.pixel = track.keyframe_pixel = track.last_keyframe_pixel = chosen.pixel;
    track.normal = chosen.normal;
    track.corner = chosen.corner;
    track.sigma_normal = chosen.sigma_normal;
    track.sigma_tangent = options_.points.weigh_edges ? chosen.sigma_tangent : chosen.sigma_normal;
    track.chain = chosen.chain;
    track.order = nearestEdgePoint(frame.edges, chosen.pixel, chosen.normal, 1.0f, -1.0f);
    track.keyframe = keyframe;
    track.keyframe_images = frame.images;
    frame.tracks.push_back(std::move(track));
  }
}

TrackedFrame Tracker::describe(const TrackedState& frame, KeyframeId keyframe, const char* reason) const {
  TrackedFrame description;
  description.frame_index = frame.images->frame_index;
  description.time_ns = frame.images->time_ns;
  description.world_T_camera = frame.world_T_camera;
  description.keyframe = keyframe;
  description.reason = reason;
  if (keyframe >= 0) description.images = frame.images;
  description.observations.reserve(frame.tracks.size());
  for (const Track& track : frame.tracks) {
    const Measurement measurement = measurementOf(track);
    description.observations.push_back(
        {track.id, measurement, bearing(camera_, measurement.pixel), track.corner, track.chain, track.order});
  }
  return description;
}

Pose Tracker::predictPose(std::int64_t time_ns) const {
  if (interval_ns_ <= 0) return last_.world_T_camera;
  // Constant velocity, but not for long: after a gap the camera has rather stopped than flown on.
  const double ahead = static_cast<double>(time_ns - last_.images->time_ns) / static_cast<double>(interval_ns_);
  const double share = std::min(ahead, 3.0);
  const Pose motion{rotationExp(share * rotationLog(last_T_next_.rotation)), share * last_T_next_.translation};
  return last_.world_T_camera * motion;
}

TrackingOutcome Tracker::skip(std::int64_t time_ns, const std::string& reason) const {
  TrackingOutcome outcome;
  outcome.reason = reason;
  if (!last_.images || !view_.initialised) return outcome;
  outcome.state = FrameState::predicted;
  outcome.world_T_camera = predictPose(time_ns);
  // Hand-held cameras accelerate by some 5 m/s^2 and 10 rad/s^2; lengths are in units of the scene's depth here.
  const double seconds = static_cast<double>(time_ns - last_.images->time_ns) * 1e-9;
  const double translation = 2.0 * seconds * seconds, rotation = 5.0 * seconds * seconds;
  outcome.covariance = last_.pose.covariance;
  outcome.covariance.diagonal().head<3>().array() += translation * translation;
  outcome.covariance.diagonal().tail<3>().array() += rotation * rotation;
  outcome.reference = view_.keyframes.back().id;
  outcome.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * outcome.world_T_camera;
  return outcome;
}

void Tracker::remember(TrackedState frame) {
  lost_since_ns_ = -1;
  const std::int64_t interval_ns = frame.images->time_ns - last_.images->time_ns;
  last_T_next_ = last_.world_T_camera.inverse() * frame.world_T_camera;
  interval_ns_ = interval_ns;
  mapped_at_keyframe_ = std::max(mapped_at_keyframe_, frame.pose.inlier_count);
  ++frames_since_keyframe_;
  const auto tracks = static_cast<double>(frame.tracks.size());
  average_tracks_ = average_tracks_ == 0 ? tracks : 0.95 * average_tracks_ + 0.05 * tracks;
  last_ = std::move(frame);
}

TrackedFrame Tracker::keepLostFrame() {
  kept_ = lost_;
  return describe(kept_, next_keyframe_++, "recovery");
}

void Tracker::resume(const MapView& view, const Pose& world_T_camera, const Matrix6d& covariance,
                     const std::vector<FoundAgain>& points) {
  TrackedState frame = std::move(kept_);
  kept_ = TrackedState();
  if (!points.empty()) frame.tracks.clear();
  for (const FoundAgain& found : points) {
    Track track;
    track.id = found.point;
    track.pixel = track.last_keyframe_pixel = found.measurement.pixel.cast<float>();
    track.normal = found.measurement.normal.cast<float>();
    track.corner = found.corner;
    track.sigma_normal = static_cast<float>(found.measurement.sigma_normal);
    track.sigma_tangent = static_cast<float>(found.measurement.sigma_tangent);
    frame.tracks.push_back(track);
  }
  std::sort(frame.tracks.begin(), frame.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
  frame.world_T_camera = world_T_camera;
  frame.pose.covariance = covariance;
  view_ = view;
  next_keyframe_ = std::max(next_keyframe_, view.keyframes.back().id + 1);
  last_ = std::move(frame);
  last_T_next_ = Pose();
  interval_ns_ = 0;
  lost_since_ns_ = -1;
  keyframe_time_ns_ = last_.images->time_ns;
  frames_since_keyframe_ = options_.keyframes.least_frames_apart;
  mapped_at_keyframe_ = options_.keyframes.fewest_mapped * 2;  // asks for a keyframe with fresh points
  average_tracks_ = 0;
}

void Tracker::startLost(const MapView& view, PointId first_free_point) {
  view_ = view;
  next_point_ = first_free_point;
  next_keyframe_ = view.keyframes.back().id + 1;
}

void Tracker::adopt(const MapView& view) {
  if (view.version <= view_.version && view.origin_frame == view_.origin_frame) return;
  if (!last_.images || view.origin_frame != view_.origin_frame) return;
  const bool first = view.initialised && !view_.initialised;
  // What mapping has not seen yet keeps its place relative to the latest keyframe known to both.
  const Pose new_T_old = newWorldTOldWorld(view_, view);
  MapView newer = view;
  for (const ViewKeyframe& keyframe : view_.keyframes) {
    if (keyframe.id <= view.keyframes.back().id) continue;
    newer.keyframes.push_back({keyframe.id, new_T_old * keyframe.world_T_camera, nullptr});
  }
  const Pose moved = new_T_old * last_.world_T_camera;
  view_ = std::move(newer);
  if (first) {
    next_keyframe_ = view_.keyframes.back().id + 1;
    keyframe_time_ns_ = last_.images->time_ns;
    frames_since_keyframe_ = options_.keyframes.least_frames_apart;
    mapped_at_keyframe_ = options_.keyframes.fewest_mapped * 2;  // the first view asks for a keyframe with fresh points
  }
  const FramePose again = estimatePose(camera_, view_, last_.tracks, moved, options_.pose);
  last_.world_T_camera = again.result.converged ? again.result.world_T_camera : moved;
}

}  // namespace edgeslam
