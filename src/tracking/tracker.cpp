#include "tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tracking/edge_tracks.h"
#include "tracking/view_centre.h"
#include "tracking/view_change.h"

namespace edgeslam {
namespace {

constexpr std::size_t scratch_size = std::size_t{8} << 20;  // a frame that needs more allocates it
constexpr int least_pyramid_levels = 6;
constexpr std::size_t most_found_again = 4096;
constexpr int fewest_of_frozen_map = 40;  // points of it that must agree with a pose
constexpr double few_left = 0.8;          // of the tracks there were when points of a frozen map were last looked for

double secondsSince(std::int64_t from_ns, std::int64_t to_ns) { return 1e-9 * static_cast<double>(to_ns - from_ns); }

// Without tracks beside the map's points, which hold the others to account as the map grows, a few points at its edge
// may agree with a pose that slides away, and a position that is held with one that was never measured.
LocationOptions locationOptions(const TrackerOptions& options) {
  LocationOptions location = options.location;
  if (!options.map_is_frozen) return location;
  location.orientation_only.enabled = false;
  location.acceptance.fewest_points = fewest_of_frozen_map;
  return location;
}

int countInMap(const MapView& view, const std::vector<Track>& tracks) {
  AscendingPoints points(view);
  return static_cast<int>(std::count_if(tracks.begin(), tracks.end(),
                                        [&](const Track& track) { return points.find(track.id) != nullptr; }));
}

// Whether a frame has this share of the edges of the one before, at least.
bool hasEdges(const FollowedFrame& frame, const FollowedFrame& before, double share) {
  const auto count = [](const FollowedFrame& f) { return static_cast<double>(f.edges->points.size()); };
  return count(frame) >= share * count(before);
}

int pyramidLevels(const TrackerOptions& options) {
  return std::max(options.location.flow.levels, least_pyramid_levels);
}

}  // namespace

Tracker::Tracker(const Camera& camera, const EdgeOptions& edges, const PointChoiceOptions& points,
                 const TrackerOptions& options)
    : calibrated_(camera),
      camera_(camera),
      options_(options),
      most_tracks_(static_cast<std::size_t>(points.count)),
      preparation_(camera, {edges, points.accuracy, options.blur_gate, pyramidLevels(options)}),
      location_(camera, locationOptions(options)),
      keyframes_(camera, options.keyframes, points),
      motion_(options.inertia, options.inertia_only, options.wheels, options.wheels_only),
      noise_(options.noise),
      confirmation_(options.map_confirmation),
      scratch_memory_(new std::byte[scratch_size]),
      scratch_(scratch_memory_.get(), scratch_size),
      spare_(most_tracks_) {
  for (FollowedFrame* frame : {&frame_, &last_, &kept_}) {
    frame->tracks.reserve(most_found_again);
    frame->straight_edges.reserve(most_tracks_);
  }
  reserveForTracking(view_);
  lost_reason_.reserve(longest_reason);
}

void Tracker::startLost(const MapView& view, PointId first_free_point) {
  view_ = view;
  takeFound(view);
  worlds_ = 1;
  last_world_ = view.world;
  keyframes_.goOnFrom(view.latest_keyframe + 1, first_free_point);
}

bool Tracker::track(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, bool mapping_busy,
                    FrameResult& result, TrackedFrame& for_mapping) {
  clear(result);
  result.index = frame_index;
  result.time_ns = time_ns;
  frame_is_lost_ = false;
  Work work{time_ns, mapping_busy, result, for_mapping, StageClock(result.times)};

  const bool is_sharp = preparation_.prepare(frame_index, time_ns, grey, frame_, work.clock);  // P1 to P4
  frame_.wheels = motion_.wheelsAt(time_ns);
  frame_.is_by_wheels = false;
  frame_.known = {};
  const double without_s = lost_since_ns_ < 0 ? 0 : secondsSince(lost_since_ns_, time_ns);
  const bool any_will_do = !mapStands() || is_lost_ || without_s > options_.blur_gate.longest_rejection_s;
  work.is_blurred = !is_sharp && !any_will_do;
  if (work.is_blurred) {
    followBlurred(work);
    return false;
  }
  if (isToBeginWorld(time_ns)) beginWorld();
  if (!mapStands() && !last_.isThere()) return startMap("first frame of the map", work);

  bool located = place(work);  // P5, P6, P16
  measureNoise(work.result);
  if (!mapStands() && (!located || (tooFewAreLeft() && !goOnFromSpare()))) {
    return startMap("starting anew: too few of the first frame's points are left", work);  // P13
  }
  bool is_told = false;
  if (is_sharp && mapStands() && located && !mapping_busy) {
    is_told = options_.map_is_frozen ? isToSeeElsewhere(for_mapping) : selectKeyframe(located, work);  // P8 to P12
  }
  if (!located) {
    lose(work);
    return is_told;
  }
  reuseMapWhenDue(work);
  tell(work);
  remember();
  if (mapStands() || mapping_busy) return is_told;
  helpStart(for_mapping);
  return true;
}

// P4: a blurred frame is no ground to build on. But where enough of the map is found in it, its pose is as good as any.
// Where blur hides most of the tracks, the next frame is followed from those of the last sharp one.
void Tracker::followBlurred(Work& work) {
  if (!locate(work) || frame_.position_is_held) {
    lost_reason_.assign("blurred image");
    if (!followCoarsely(work)) predict(work.time_ns, lost_reason_, work.result);
    figures_.is_leap = false;
    return beLostSince(work.time_ns);
  }
  tell(work);
  const auto kept = static_cast<double>(frame_.tracks.size());
  if (kept < options_.blurred_tracks_share * static_cast<double>(last_.tracks.size())) return beLostSince(work.time_ns);
  remember();
}

// What neither blur nor a jerk takes from the images is on the coarser levels of their pyramids. What is found there is
// a pose, and how the camera moves; the next frame is followed from the last one that showed more. `lost_reason_` says
// why that one is not this. A place that was found again may be another that looks alike: what confirms it is fine.
bool Tracker::followCoarsely(Work& work) {
  if (!mapStands() || options_.map_is_frozen || !last_.isThere() || figures_.is_leap) return false;
  if (last_was_found_again_) return false;
  if (lost_since_ns_ >= 0 && secondsSince(lost_since_ns_, work.time_ns) > options_.regain_seconds) return false;
  if (!hasEdges(frame_, last_, options_.coarse_fewest_edges)) return false;
  scratch_.release();
  LocationFigures figures;
  const LocationPrior prior = priorFor(work, Following::coarsely);
  if (!location_.locate(last_, view_, prior, frame_, figures, scratch_, work.clock)) return false;
  tell(work);
  work.result.reason.assign("followed coarsely: ").append(lost_reason_);
  motion_.observeCoarsely(last_, frame_);
  return true;
}

LocationPrior Tracker::priorFor(const Work& work, Following how) const {
  const InertialPrediction predicted = motion_.predict(last_, work.time_ns, view_);
  const bool is_coarse = how == Following::coarsely;
  return {predicted.world_T_camera,
          mapStands() ? priorOf(predicted) : PosePrior(),
          is_coarse || lost_since_ns_ >= 0 || last_was_found_again_ || work.is_blurred,
          located_in_a_row_ >= 2,
          is_coarse,
          preparation_.accuracy(),
          motion_.whileRowsAreRead(last_, work.time_ns, mapStands())};
}

// P13, P14
void Tracker::helpStart(TrackedFrame& for_mapping) {
  FrameKind kind = FrameKind::start;
  KeyframeId keyframe = -1;
  if (isToKeepSpare()) {
    kind = FrameKind::spare;
    keyframe = keyframes_.firstOfWorld();
    const PointId first_new = keyframes_.choosePointsOfSpare(last_, preparation_.accuracy());
    spare_.begin(camera_, last_, keyframe, first_new);
  }
  keepEdgesOfStart(last_);
  describe(camera_, last_, {kind, keyframe, "first", 1, 0, view_.origin_frame}, for_mapping);
  for_mapping.inertia = motion_.inertia().linkSinceStart(last_.images->time_ns);
}

// Long after the last frame that was located its points are not looked for any more, nor after a leap: a place that
// looks alike goes on looking alike.
bool Tracker::locate(Work& work) {
  if (figures_.is_leap) return false;
  figures_ = {};
  if (!last_.isThere()) return false;
  const bool is_lost = lost_since_ns_ >= 0;
  if (is_lost && secondsSince(lost_since_ns_, work.time_ns) > options_.regain_seconds) return false;
  scratch_.release();
  const LocationPrior prior = priorFor(work, Following::finely);
  const bool is_located = location_.locate(last_, view_, prior, frame_, figures_, scratch_, work.clock);
  if (figures_.is_leap) frame_.tracks.clear();  // nor is it recovered by them
  return is_located;
}

// By the map's points, or else by the wheels; these also where the points tell how the camera turned, but not where it
// is.
bool Tracker::place(Work& work) {
  frame_.is_by_wheels = false;
  if (!locate(work)) return goOnByWheels(work.time_ns);
  if (!frame_.position_is_held || options_.map_is_frozen) return true;
  if (const std::optional<WheelPrediction> carried = carriedByWheels(work.time_ns)) {
    frame_.world_T_camera.translation = carried->world_T_camera.translation;
    bePlacedByWheels(carried->covariance);
  }
  return true;
}

void Tracker::bePlacedByWheels(const Matrix6d& covariance) {
  lost_reason_.clear();
  describe(figures_, lost_reason_);
  frame_.is_by_wheels = true;
  frame_.position_is_held = false;
  frame_.covariance = covariance;
}

// A frame that shows something, but nothing of the map, is where the wheels say: the map grows on from it.
bool Tracker::goOnByWheels(std::int64_t time_ns) {
  if (options_.map_is_frozen) return false;
  const std::optional<WheelPrediction> carried = carriedByWheels(time_ns);
  if (!carried || !hasEdges(frame_, last_, options_.wheels_only.fewest_edges)) return false;
  bePlacedByWheels(carried->covariance);
  frame_.world_T_camera = carried->world_T_camera;
  frame_.twist.setZero();
  frame_.inlier_count = 0;
  frame_.outlier_share = 0;
  frame_.scene_depth = last_.scene_depth;
  reuseMap(frame_);
  return true;
}

// What is measured from now on, and what was measured already and is looked at again, counts as it says.
void Tracker::measureNoise(FrameResult& result) {
  if (saysSomething(frame_.noise)) result.measured_noise = noise_.factor() * frame_.noise.ratio;
  const double change = noise_.observe(frame_.noise);
  if (change == 1) return;
  preparation_.setNoiseFactor(noise_.factor());
  for (std::vector<Track>* tracks : {&frame_.tracks, &last_.tracks}) {
    for (Track& track : *tracks) {
      track.sigma_normal *= static_cast<float>(change);
      track.sigma_tangent *= static_cast<float>(change);
    }
  }
}

bool Tracker::tooFewAreLeft() {
  const auto left = static_cast<double>(spare_.countOlder(frame_.tracks));
  const bool is_faded = left < options_.restart_share * static_cast<double>(tracks_at_start_);
  faded_frames_ = is_faded ? faded_frames_ + 1 : 0;
  return faded_frames_ >= options_.restart_frames || left < options_.fewest_tracks;
}

bool Tracker::isToKeepSpare() const {
  return !spare_.isThere() &&
         static_cast<double>(last_.tracks.size()) < options_.spare_share * static_cast<double>(tracks_at_start_);
}

// False where there is none, or too little of it is left.
bool Tracker::goOnFromSpare() {
  if (!spare_.isThere()) return false;
  const auto at_start = static_cast<double>(spare_.first().observations.size());
  const auto fewest = std::max<double>(options_.fewest_tracks, options_.restart_share * at_start);
  if (static_cast<double>(frame_.tracks.size()) < fewest) return false;
  spare_.adopt(last_);
  spare_.adopt(frame_);
  makeFlatView(spare_.first(), view_);
  tracks_at_start_ = spare_.first().observations.size();
  faded_frames_ = 0;
  spare_.forget();
  return true;
}

bool Tracker::isToBeginWorld(std::int64_t time_ns) const {
  if (!options_.worlds_enabled || options_.map_is_frozen || !mapStands() || lost_since_ns_ < 0) return false;
  const bool is_due = motion_.hasInertia() ? !isPredictedStill(time_ns)
                                           : lost_sharp_since_ns_ >= 0 && secondsSince(lost_sharp_since_ns_, time_ns) >
                                                                              options_.new_world_seconds;
  return is_due && !carriedByWheels(time_ns);
}

// What was there is no longer tracked, but is looked for.
void Tracker::beginWorld() {
  spare_.forget();
  view_.initialised = false;
  is_lost_ = false;
  beFound();
  last_.forget();
  motion_.forget();
  confirmation_.forget();
  motion_.inertia().forgetLink();
  keyframes_.beginWorld();
}

bool Tracker::startMap(const char* reason, Work& work) {
  last_.forget();
  spare_.forget();
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
  keepEdgesOfStart(frame_);
  describe(camera_, frame_, {FrameKind::first, keyframes_.firstOfWorld(), "first"}, work.for_mapping);
  makeFlatView(work.for_mapping, view_);
  tracks_at_start_ = frame_.tracks.size();
  faded_frames_ = 0;
  motion_.forget();
  motion_.inertia().beginStart(work.for_mapping.keyframe, work.time_ns);
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
      located = place(work);
      return true;
  }
  return false;
}

void Tracker::keepEdgesOfStart(FollowedFrame& frame) {
  scratch_.release();
  const StraightEdges straight = straightEdges(camera_, *frame.edges, options_.straight_edges, &scratch_);
  keepStraightEdges(camera_, straight, noise_.factor(), frame, &scratch_);
}

void Tracker::becomeKeyframe(FollowedFrame& frame, const char* reason, Work& work) {
  reuseMap(frame);
  work.clock.finished(Stage::map_reuse);
  const StraightEdges straight = straightEdges(camera_, *frame.edges, options_.straight_edges, &scratch_);
  putOnStraightEdges(camera_, straight, frame);
  const KeyframeId id = keyframes_.make(frame, preparation_.accuracy());
  keepStraightEdges(camera_, straight, noise_.factor(), frame, &scratch_);
  describe(camera_, frame, {FrameKind::keyframe, id, reason, noise_.factor(), view_.world}, work.for_mapping);
  work.for_mapping.inertia = motion_.inertia().linkTo(id, frame.images->time_ns, view_.inertia);
  motion_.inertia().tell(work.for_mapping);
  // Until mapping answers, the keyframe stands where tracking saw it.
  view_.keyframes.push_back({id, frame.world_T_camera, nullptr, Matrix7d::Zero(), frame.twist});
  work.clock.finished(Stage::choice_of_points);
}

// In a frozen map: true where the camera came nearer to another keyframe than to that which the view is around.
bool Tracker::isToSeeElsewhere(TrackedFrame& for_mapping) {
  const KeyframeId nearest = nearestKeyframe(view_, frame_.world_T_camera, frame_.scene_depth, centre_);
  if (nearest == centre_) return false;
  centre_ = nearest;
  describe(camera_, frame_, {FrameKind::elsewhere, nearest, "", noise_.factor(), view_.world}, for_mapping);
  return true;
}

// A frozen map's points are all there is to track, so that they are looked for as soon as they become few.
bool Tracker::isReuseDue() const {
  const int interval = options_.map_reuse.interval;
  if (!options_.map_is_frozen) return keyframes_.frames() % interval == interval - 1;
  const double few = few_left * static_cast<double>(tracks_at_reuse_);
  return since_reuse_ + 1 >= interval || static_cast<double>(frame_.tracks.size()) <= few || tracks_at_reuse_ == 0;
}

void Tracker::reuseMapWhenDue(Work& work) {
  if (!mapStands()) return;
  if (!isReuseDue()) {
    ++since_reuse_;
    return;
  }
  reuseMap(frame_);
  since_reuse_ = 0;
  tracks_at_reuse_ = frame_.tracks.size();
  work.clock.finished(Stage::map_reuse);
}

void Tracker::reuseMap(FollowedFrame& frame) {
  scratch_.release();
  const std::optional<PointsConfirmed> of_map =
      reuseMapPoints(camera_, view_, *frame.images, *frame.edges, {frame.world_T_camera, frame.twist}, most_tracks_,
                     options_.map_reuse, frame.tracks, &scratch_);
  if (of_map) {
    confirmation_.observe(*of_map, {frame.world_T_camera, frame.images->time_ns, view_.keyframes.back().id});
  }
}

void Tracker::tell(Work& work) {
  FrameResult& result = work.result;
  result.noise_factor = noise_.factor();
  result.world_T_camera = frame_.world_T_camera;
  result.covariance = frame_.covariance;
  result.tracked_points = static_cast<int>(frame_.tracks.size());
  result.mapped_points = frame_.inlier_count;
  if (!options_.map_is_frozen && !frame_.position_is_held && !frame_.is_by_wheels) {
    pack(camera_, frame_.tracks, most_tracks_, result.seen);
  }
  if (!mapStands()) {
    result.reason = view_.waiting_for;
    return;
  }
  scratch_.release();
  map_covariance_ = mapUncertaintyAt(view_, frame_.tracks, frame_.world_T_camera, &scratch_);
  result.state = TrackingState::tracking;
  result.has_pose = true;
  result.position_is_held = frame_.position_is_held;
  if (frame_.position_is_held) {
    result.reason.assign("orientation only, the position is held: ");
    result.reason.append(std::to_string(frame_.inlier_count)).append(" map points in view agree");
  }
  if (frame_.is_by_wheels) result.reason.assign("wheels only: ").append(lost_reason_);
  result.world = last_world_ = view_.world;
  result.inertia = view_.inertia;
  result.wheels = view_.wheels;
  result.world_covariance = worldCovariance(camera_, withSharedNoise(frame_.covariance), map_covariance_,
                                            frame_.outlier_share, options_.uncertainty);
  tellDoubt(result);
  tellMotion(frame_.world_T_camera, result);
  result.reference = view_.keyframes.back().id;
  result.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * frame_.world_T_camera;
}

void Tracker::tellDoubt(FrameResult& result) const {
  if (!confirmation_.lastBeforeDoubt()) return;
  result.world_covariance.topLeftCorner<3, 3>().diagonal().array() +=
      confirmation_.positionVariance(result.world_T_camera);
  if (!result.reason.empty()) return;
  result.reason.assign("in doubt: of ").append(std::to_string(confirmation_.points().expected));
  result.reason.append(" map points that should be in view ");
  result.reason.append(std::to_string(confirmation_.points().confirmed)).append(" are found");
}

void Tracker::tellMotion(const Pose& world_T_camera, FrameResult& result) const {
  result.map_corrections = view_.corrections;
  if (!last_.isThere()) return;
  result.has_motion = true;
  result.previous_time_ns = last_.images->time_ns;
  result.previous_T_camera = last_.world_T_camera.inverse() * world_T_camera;
  result.previous_position_was_held = last_.position_is_held;
}

// What makes a camera err more than presumed makes neighbouring points err alike: many of them say no more than a few.
Matrix6d Tracker::withSharedNoise(const Matrix6d& covariance) const {
  return noise_.factor() * noise_.factor() * covariance;
}

void Tracker::remember() {
  if (is_lost_) {
    preparation_.forgetSharpness();
    confirmation_.askForProof();
  }
  is_lost_ = false;
  beFound();
  last_was_found_again_ = false;
  located_in_a_row_ = mapStands() ? located_in_a_row_ + 1 : 0;
  const double sigma = std::sqrt(withSharedNoise(frame_.covariance).topLeftCorner<3, 3>().trace() / 3);
  motion_.observe(last_, frame_, sigma, view_);
  if (!options_.map_is_frozen) keyframes_.follow(frame_);
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
  const InertialPrediction prediction = motion_.predict(last_, time_ns, view_);
  result.state = TrackingState::predicted;
  result.has_pose = true;
  result.world = view_.world;
  result.inertia = view_.inertia;
  result.wheels = view_.wheels;
  result.world_T_camera = prediction.world_T_camera;
  tellMotion(result.world_T_camera, result);
  result.covariance = prediction.covariance;
  result.world_covariance = worldCovariance(camera_, withSharedNoise(result.covariance), map_covariance_,
                                            last_.outlier_share, options_.uncertainty);
  tellDoubt(result);
  if (view_.keyframes.empty()) return;
  if (motion_.isKnownByInertia(prediction, last_, time_ns)) return goOnBy("inertia only", result);
  if (carriedByWheels(time_ns)) goOnBy("wheels only", result);
}

std::optional<WheelPrediction> Tracker::carriedByWheels(std::int64_t time_ns) const {
  if (!last_.isThere() || !mapStands() || view_.keyframes.empty()) return std::nullopt;
  return motion_.carriedByWheels(last_, frame_, time_ns, view_);
}

// What is known so well is a pose as good as a measured one, whatever it is `by`.
void Tracker::goOnBy(std::string_view by, FrameResult& result) const {
  result.state = TrackingState::tracking;
  if (!result.reason.empty()) result.reason.insert(0, ": ");
  result.reason.insert(0, by);
  result.reference = view_.keyframes.back().id;
  result.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * result.world_T_camera;
}

void Tracker::lose(Work& work) {
  FrameResult& result = work.result;
  lost_reason_.clear();
  describe(figures_, lost_reason_);
  if (followCoarsely(work)) return beLostSince(work.time_ns);
  predict(work.time_ns, lost_reason_, result);
  beLostSince(work.time_ns);
  if (lost_sharp_since_ns_ < 0) lost_sharp_since_ns_ = work.time_ns;
  frame_is_lost_ = is_lost_ = true;
  if (isGoodPose(result.state)) return;  // by inertia or the wheels
  // What a frozen map does not show is bridged; a map that grows shows what was there a moment ago.
  if (options_.map_is_frozen && result.has_pose && isPredictedStill(work.time_ns)) return;
  result.state = TrackingState::lost;
  result.has_pose = false;
  result.world = -1;
}

bool Tracker::isPredictedStill(std::int64_t time_ns) const {
  return secondsSince(lost_since_ns_, time_ns) <= options_.predicted_seconds;
}

void Tracker::beLostSince(std::int64_t time_ns) {
  located_in_a_row_ = 0;
  if (lost_since_ns_ < 0) lost_since_ns_ = time_ns;
}

void Tracker::beFound() {
  lost_since_ns_ = lost_sharp_since_ns_ = -1;
  figures_.is_leap = false;
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
  kept_number_ = keyframes_.numberOfLost();
  describe(camera_, kept_, {FrameKind::lost, kept_number_, "recovery", noise_.factor(), last_world_}, description);
  description.inertia = motion_.inertia().linkUpTo(kept_.images->time_ns, view_.inertia);
}

void Tracker::keepLatestFrame(TrackedFrame& description) {
  kept_number_ = -1;
  kept_.images = last_.images;
  kept_.edges = last_.edges;
  kept_.tracks.clear();
  describe(camera_, kept_, {FrameKind::lost, -1, "", noise_.factor(), last_world_}, description);
}

void Tracker::resume(MapView& view, const Pose& world_T_camera, const Matrix6d& covariance,
                     const std::vector<FoundAgain>& points) {
  std::swap(last_, kept_);
  kept_.forget();
  spare_.forget();
  keepConfirmation(view, points.empty());
  if (!points.empty()) last_.tracks.clear();
  for (const FoundAgain& found : points) last_.tracks.push_back(trackOf(found));
  if (options_.map_is_frozen) compareWithMap(view, last_.tracks);
  centre_ = view.centre;
  tracks_at_reuse_ = 0;
  std::sort(last_.tracks.begin(), last_.tracks.end(), [](const Track& a, const Track& b) { return a.id < b.id; });
  last_.world_T_camera = world_T_camera;
  last_.twist.setZero();
  last_.covariance = covariance;
  last_.known = {};
  last_.seen_turn.setZero();
  std::swap(view_, view);
  last_.inlier_count = countInMap(view_, last_.tracks);
  last_was_found_again_ = true;
  takeFound(view_);
  last_.is_by_wheels = false;
  motion_.goOnFrom(last_);
  if (view_.keyframes.contains(kept_number_)) motion_.inertia().linkFrom(kept_number_, last_.images->time_ns);
  is_lost_ = false;
  beFound();
  preparation_.forgetSharpness();
  keyframes_.seen(view_.latest_keyframe);
  keyframes_.forgetAverage();
  keyframes_.askForOne(last_);
}

// What was found in the map as a whole is believed. Tracks that agree with the latest keyframes may all follow
// something that moves.
void Tracker::keepConfirmation(const MapView& view, bool by_tracks) {
  const std::optional<Similarity> new_S_old = by_tracks ? newWorldSOldWorld(view_, view) : std::nullopt;
  if (!new_S_old) return confirmation_.forget();
  confirmation_.move(*new_S_old);
  confirmation_.askForProof();
}

// Mapping found the camera to be another one than its calibration says, the clocks to differ, or the unit to be
// turned otherwise.
void Tracker::takeFound(const MapView& view) {
  if (view.time_offset) motion_.inertia().setOffset(view.time_offset->offset_ns);
  if (view.unit_is_left_out) motion_.inertia().leaveOut();
  if (view.unit_rotation) motion_.inertia().setRotation(view.unit_rotation->imu_R_camera);
  const Camera camera = withFound(calibrated_, view.found);
  if (camera == camera_) return;
  camera_ = camera;
  location_.setCamera(camera);
  keyframes_.setCamera(camera);
}

void Tracker::linkFromLatestKeyframe() {
  const ViewKeyframe& latest = view_.keyframes.back();
  if (latest.images) {
    motion_.inertia().linkFrom(latest.id, latest.images->time_ns);
  } else {
    motion_.inertia().forgetLink();
  }
}

void Tracker::adopt(MapView& view) {
  if (!last_.isThere() || view.version <= view_.version) return;
  const bool is_of_this_start = !mapStands() && view.origin_frame == view_.origin_frame;
  const bool is_of_this_map = mapStands() && view.initialised;
  if (!is_of_this_start && !is_of_this_map) return;
  const std::optional<Similarity> new_S_old = newWorldSOldWorld(view_, view);
  if (!new_S_old) return;
  const bool is_first = view.initialised && !mapStands();
  // What mapping has not seen yet keeps its place relative to the latest keyframe known to both.
  const KeyframeId latest = view.keyframes.back().id;
  for (const ViewKeyframe& keyframe : view_.keyframes) {
    if (keyframe.id <= latest) continue;
    view.keyframes.push_back({keyframe.id, moved(*new_S_old, keyframe.world_T_camera), nullptr, Matrix7d::Zero(),
                              moved(*new_S_old, keyframe.twist)});
  }
  if (view.corrections != view_.corrections || view.wheels.is_known != view_.wheels.is_known) {
    motion_.forgetWheels();
  }
  std::swap(view_, view);
  takeFound(view_);
  centre_ = view_.centre;  // what was asked for meanwhile is asked for once more
  tracks_at_reuse_ = 0;
  motion_.scale(new_S_old->scale);
  confirmation_.move(*new_S_old);
  const Pose moved_pose = moved(*new_S_old, last_.world_T_camera);
  if (is_first) {
    ++worlds_;
    spare_.forget();
    keyframes_.seen(view_.latest_keyframe);
    keyframes_.askForOne(last_);
    linkFromLatestKeyframe();
  }
  scratch_.release();
  last_.twist = moved(*new_S_old, last_.twist);
  last_.known = moved(*new_S_old, last_.known);
  last_.scene_depth *= new_S_old->scale;
  RowMotion motion;
  motion.before = last_.twist;
  const FramePose again =
      estimatePose(camera_, view_, last_.tracks, moved_pose, options_.location.pose, &scratch_, motion, last_.known);
  const bool is_measured = again.result.converged && !last_.is_by_wheels;
  last_.world_T_camera = is_measured ? again.result.world_T_camera : moved_pose;
  if (is_measured && !last_.position_is_held) last_.seen_turn = again.result.without_prior.tail<3>();
}

}  // namespace edgeslam
