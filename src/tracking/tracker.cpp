#include "tracking/tracker.h"

#include <algorithm>
#include <utility>

namespace edgeslam {
namespace {

constexpr std::size_t scratch_size = std::size_t{8} << 20;  // a frame that needs more allocates it
constexpr int least_pyramid_levels = 6;
constexpr std::size_t most_found_again = 4096;

int pyramidLevels(const TrackerOptions& options) {
  return std::max(options.location.flow.levels, least_pyramid_levels);
}

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

Tracker::Tracker(const Camera& camera, const EdgeOptions& edges, const PointChoiceOptions& points,
                 const TrackerOptions& options)
    : camera_(camera),
      options_(options),
      most_tracks_(static_cast<std::size_t>(points.count)),
      preparation_(camera, {edges, points.accuracy, options.blur_gate, pyramidLevels(options)}),
      location_(camera, options.location),
      keyframes_(camera, options.keyframes, points),
      scratch_memory_(scratch_size),
      scratch_(scratch_memory_.data(), scratch_memory_.size()) {
  for (FollowedFrame* frame : {&frame_, &last_, &kept_}) frame->tracks.reserve(most_found_again);
  reserveForTracking(view_);
}

void Tracker::startLost(const MapView& view, PointId first_free_point) {
  view_ = view;
  keyframes_.goOnFrom(view.keyframes.back().id + 1, first_free_point);
}

bool Tracker::track(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, bool mapping_busy,
                    FrameResult& result, TrackedFrame& for_mapping) {
  clear(result);
  result.index = frame_index;
  result.time_ns = time_ns;
  frame_is_lost_ = false;
  Work work{time_ns, mapping_busy, result, for_mapping, StageClock(result.times)};

  const bool is_sharp = preparation_.prepare(frame_index, time_ns, grey, frame_, work.clock);  // P1 to P4
  if (!is_sharp && last_.isThere()) {
    beLostSince(time_ns);
    predict(time_ns, "blurred image", result);
    return false;
  }
  if (!mapStands() && !last_.isThere()) return startMap("first frame of the map", work);

  bool located = locate(work);  // P5, P6, P16
  if (!mapStands() && (!located || tooFewAreLeft())) {
    return startMap("starting anew: too few of the first frame's points are left", work);  // P13
  }
  const bool is_told = mapStands() && located && !mapping_busy && selectKeyframe(located, work);  // P8 to P12
  if (!located) {
    lose("map points not found again", work);
    return is_told;
  }
  reuseMapWhenDue(work);
  tell(work);
  remember();
  if (mapStands() || mapping_busy) return is_told;
  describe(camera_, last_, {FrameKind::start, -1, ""}, for_mapping);  // P13, P14
  return true;
}

// Long after the last frame that was located its points are not looked for any more.
bool Tracker::locate(Work& work) {
  if (!last_.isThere()) return false;
  const bool regains = lost_since_ns_ >= 0;
  if (regains && static_cast<double>(work.time_ns - lost_since_ns_) * 1e-9 > options_.regain_seconds) return false;
  scratch_.release();
  const LocationPrior prior{motion_.predict(lastCamera(), work.time_ns), regains, preparation_.accuracy()};
  return location_.locate(last_, view_, prior, frame_, scratch_, work.clock);
}

bool Tracker::tooFewAreLeft() const {
  return static_cast<double>(frame_.tracks.size()) < options_.restart_share * static_cast<double>(tracks_at_start_);
}

bool Tracker::startMap(const char* reason, Work& work) {
  last_.forget();
  if (work.mapping_busy) {
    work.result.reason = "mapping is behind";
    return false;
  }
  keyframes_.choosePointsOfFirst(frame_, preparation_.accuracy());
  const auto chosen = static_cast<int>(frame_.tracks.size());
  work.result.tracked_points = chosen;
  work.clock.finished(Stage::choice_of_points);
  if (chosen < options_.fewest_tracks) {
    work.result.reason = "too few points on edges (";
    work.result.reason += std::to_string(chosen);
    work.result.reason += ")";
    return false;
  }
  work.result.reason = reason;
  keyframes_.startedMap();
  describe(camera_, frame_, {FrameKind::first, 0, "first"}, work.for_mapping);
  makeFlatView(work.for_mapping, view_);
  tracks_at_start_ = frame_.tracks.size();
  motion_.forget();
  std::swap(last_, frame_);
  return true;
}

// True where a frame became one. Where that was the frame before, this one is located anew, from its fresh points.
bool Tracker::selectKeyframe(bool& located, Work& work) {
  const KeyframeDecision decision = keyframes_.judge(view_, frame_);
  switch (decision.choice) {
    case KeyframeChoice::none:
      return false;
    case KeyframeChoice::current_frame:
      becomeKeyframe(frame_, decision.reason, work);
      return true;
    case KeyframeChoice::previous_frame:
      becomeKeyframe(last_, decision.reason, work);
      located = locate(work);
      return true;
  }
  return false;
}

void Tracker::becomeKeyframe(FollowedFrame& frame, const char* reason, Work& work) {
  reuseMap(frame);
  const KeyframeId id = keyframes_.make(frame, preparation_.accuracy());
  describe(camera_, frame, {FrameKind::keyframe, id, reason}, work.for_mapping);
  // Until mapping answers, the keyframe stands where tracking saw it.
  view_.keyframes.push_back({id, frame.world_T_camera, nullptr});
  work.clock.finished(Stage::choice_of_points);
}

void Tracker::reuseMapWhenDue(Work& work) {
  const int interval = options_.map_reuse.interval;
  if (!mapStands() || keyframes_.frames() % interval != interval - 1) return;
  reuseMap(frame_);
  work.clock.finished(Stage::map_reuse);
}

void Tracker::reuseMap(FollowedFrame& frame) {
  scratch_.release();
  reuseMapPoints(camera_, view_, *frame.images, *frame.edges, frame.world_T_camera, most_tracks_, options_.map_reuse,
                 frame.tracks, &scratch_);
}

void Tracker::tell(Work& work) {
  FrameResult& result = work.result;
  result.world_T_camera = frame_.world_T_camera;
  result.covariance = frame_.covariance;
  result.tracked_points = static_cast<int>(frame_.tracks.size());
  result.mapped_points = frame_.inlier_count;
  if (!mapStands()) {
    result.reason = view_.waiting_for;
    return;
  }
  scratch_.release();
  map_covariance_ = mapUncertaintyAt(view_, frame_.tracks, frame_.world_T_camera, &scratch_);
  result.state = TrackingState::tracking;
  result.has_pose = true;
  result.world_covariance =
      worldCovariance(camera_, frame_.covariance, map_covariance_, frame_.outlier_share, options_.uncertainty);
  result.reference = view_.keyframes.back().id;
  result.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * frame_.world_T_camera;
}

void Tracker::remember() {
  lost_since_ns_ = -1;
  motion_.observe(lastCamera(), {frame_.images->time_ns, frame_.world_T_camera});
  keyframes_.follow(frame_);
  std::swap(last_, frame_);
}

void Tracker::skip(std::int64_t frame_index, std::int64_t time_ns, const std::string& reason,
                   FrameResult& result) const {
  clear(result);
  result.index = frame_index;
  result.time_ns = time_ns;
  predict(time_ns, reason, result);
}

void Tracker::predict(std::int64_t time_ns, std::string_view reason, FrameResult& result) const {
  result.reason = reason;
  if (!last_.isThere() || !mapStands()) return;
  result.state = TrackingState::predicted;
  result.has_pose = true;
  result.world_T_camera = motion_.predict(lastCamera(), time_ns);
  const double seconds = static_cast<double>(time_ns - last_.images->time_ns) * 1e-9;
  result.covariance = MotionModel::predictedCovariance(last_.covariance, seconds);
  result.world_covariance =
      worldCovariance(camera_, result.covariance, map_covariance_, last_.outlier_share, options_.uncertainty);
}

void Tracker::lose(const char* reason, Work& work) {
  predict(work.time_ns, reason, work.result);
  work.result.state = TrackingState::lost;
  work.result.has_pose = false;
  beLostSince(work.time_ns);
  frame_is_lost_ = true;
}

void Tracker::beLostSince(std::int64_t time_ns) {
  if (lost_since_ns_ < 0) lost_since_ns_ = time_ns;
}

const EdgeMap* Tracker::latestEdges() const {
  for (const FollowedFrame* frame : {&last_, &kept_, &frame_}) {
    if (frame->isThere() && frame->images == latestImages()) return frame->edges.get();
  }
  return nullptr;
}

void Tracker::keepLostFrame(TrackedFrame& description) {
  std::swap(kept_, frame_);
  frame_is_lost_ = false;
  describe(camera_, kept_, {FrameKind::lost, keyframes_.numberOfLost(), "recovery"}, description);
}

void Tracker::resume(MapView& view, const Pose& world_T_camera, const Matrix6d& covariance,
                     const std::vector<FoundAgain>& points) {
  std::swap(last_, kept_);
  kept_.forget();
  if (!points.empty()) last_.tracks.clear();
  for (const FoundAgain& found : points) last_.tracks.push_back(trackOf(found));
  std::sort(last_.tracks.begin(), last_.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
  last_.world_T_camera = world_T_camera;
  last_.covariance = covariance;
  last_.inlier_count = 0;
  std::swap(view_, view);
  motion_.forget();
  lost_since_ns_ = -1;
  keyframes_.seen(view_.keyframes.back().id);
  keyframes_.forgetAverage();
  keyframes_.askForOne(last_);
}

void Tracker::adopt(MapView& view) {
  if (view.version <= view_.version && view.origin_frame == view_.origin_frame) return;
  if (!last_.isThere() || view.origin_frame != view_.origin_frame) return;
  const bool is_first = view.initialised && !mapStands();
  // What mapping has not seen yet keeps its place relative to the latest keyframe known to both.
  const Pose new_T_old = newWorldTOldWorld(view_, view);
  const KeyframeId latest = view.keyframes.back().id;
  for (const ViewKeyframe& keyframe : view_.keyframes) {
    if (keyframe.id > latest) view.keyframes.push_back({keyframe.id, new_T_old * keyframe.world_T_camera, nullptr});
  }
  std::swap(view_, view);
  const Pose moved = new_T_old * last_.world_T_camera;
  if (is_first) {
    keyframes_.seen(view_.keyframes.back().id);
    keyframes_.askForOne(last_);
  }
  scratch_.release();
  const FramePose again = estimatePose(camera_, view_, last_.tracks, moved, options_.location.pose, &scratch_);
  last_.world_T_camera = again.result.converged ? again.result.world_T_camera : moved;
}

}  // namespace edgeslam
