#include "tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "edges/image_noise.h"
#include "tracking/measurement_accuracy.h"
#include "tracking/point_following.h"

namespace edgeslam {
namespace {

constexpr std::size_t scratch_size = std::size_t{8} << 20;  // a frame that needs more allocates it
constexpr int images_at_start = 8;
constexpr int edge_maps = 5;  // the current, the last, the lost and the kept frame's, and one that mapping looks at
constexpr std::size_t most_found_again = 4096;

double squared(double value) { return value * value; }

int pyramidLevels(const TrackerOptions& options) { return std::max(options.flow.levels, 6); }

// As made anew, but with its memory.
void clear(TrackingOutcome& outcome) {
  outcome.state = FrameState::initialising;
  outcome.reason.clear();
  outcome.world_T_camera = outcome.reference_T_camera = Pose();
  outcome.covariance.setZero();
  outcome.world_covariance.setZero();
  outcome.reference = -1;
  outcome.tracked_points = outcome.mapped_points = 0;
  outcome.tells_mapping = false;
  outcome.times = StageTimes();
}

}  // namespace

Tracker::Tracker(const Camera& camera, const TrackerOptions& options)
    : camera_(camera),
      options_(options),
      rotation_grids_(makeRotationGrids(camera)),
      image_pool_([size = cv::Size(camera.width, camera.height), options](FrameImages& images) {
        buildPyramid(cv::Mat(size, CV_8U, cv::Scalar(0)), pyramidLevels(options), images.pyramid);
      }),
      edge_pool_([size = cv::Size(camera.width, camera.height)](EdgeMap& edges) { edges = makeEdgeMap(size); }),
      scratch_memory_(scratch_size),
      scratch_(scratch_memory_.data(), scratch_memory_.size()) {
  image_pool_.keepReady(images_at_start);
  edge_pool_.keepReady(edge_maps);
  for (TrackedState* state : {&frame_, &lost_, &kept_, &last_}) state->tracks.reserve(most_found_again);
  occupied_.reserve(static_cast<std::size_t>(options.points.count));
  chosen_.reserve(static_cast<std::size_t>(options.points.count));
  reserveForTracking(view_);
  takeMemory();
}

// A first frame makes the workspaces take what any frame of this size may need.
void Tracker::takeMemory() {
  cv::Mat square(camera_.height, camera_.width, CV_8U, cv::Scalar(0));
  square(cv::Rect(square.cols / 4, square.rows / 4, square.cols / 2, square.rows / 2)).setTo(255);
  EdgeMap edges = makeEdgeMap(square.size());
  detectEdges(square, options_.edges, edge_workspace_, edges);
  choosePoints(square, edges, occupied_, options_.points, choice_workspace_, chosen_);
}

void Tracker::track(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, bool mapping_busy,
                    TrackingOutcome& outcome) {
  clear(outcome);
  lost_.images.reset();
  StageClock clock(outcome.times);
  prepare(frame_index, time_ns, grey, clock);
  if (isBlurred(blur_gate_, sharpness(grey, *frame_.edges), options_.blur_gate) && last_.images) {
    if (lost_since_ns_ < 0) lost_since_ns_ = time_ns;
    return predict(time_ns, "blurred image", outcome);
  }
  if (!last_.images && !view_.initialised) return startMap("first frame of the map", mapping_busy, clock, outcome);

  bool located = !isLost(time_ns) && followAndLocate(clock);
  if (!view_.initialised && (!located || static_cast<double>(frame_.tracks.size()) <
                                             options_.restart_share * static_cast<double>(tracks_at_start_))) {
    return startMap("starting anew: too few of the first frame's points are left", mapping_busy, clock, outcome);
  }
  if (view_.initialised && located && !mapping_busy) {
    const KeyframeDecision decision = judge();
    if (decision.choice == KeyframeChoice::previous_frame) {
      becomeKeyframe(last_, decision.reason, outcome);
      clock.finished(Stage::choice_of_points);
      located = followAndLocate(clock);
    } else if (decision.choice == KeyframeChoice::current_frame) {
      becomeKeyframe(frame_, decision.reason, outcome);
      clock.finished(Stage::choice_of_points);
    }
  }
  if (!located) return lose(time_ns, "map points not found again", outcome);
  if (view_.initialised && frames_since_keyframe_ % options_.map_reuse.interval == options_.map_reuse.interval - 1) {
    reuseMap(frame_);
    clock.finished(Stage::map_reuse);
  }
  report(mapping_busy, outcome);
  remember();
}

void Tracker::prepare(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, StageClock& clock) {
  std::shared_ptr<FrameImages> images = image_pool_.take();
  images->frame_index = frame_index;
  images->time_ns = time_ns;
  buildPyramid(grey, pyramidLevels(options_), images->pyramid);
  clock.finished(Stage::pyramid);
  if (!frame_.edges || frame_.edges.use_count() > 1) frame_.edges = edge_pool_.take();
  detectEdges(images->pyramid.levels[0], options_.edges, edge_workspace_, *frame_.edges);
  points_ = withNoiseOf(images->pyramid.levels[0], options_.points);
  clock.finished(Stage::edges);
  frame_.tracks.clear();
  frame_.covariance.setZero();
  frame_.inlier_count = 0;
  frame_.outlier_share = 0;
  frame_.images = latest_images_ = std::move(images);
}

const EdgeMap* Tracker::latestEdges() const {
  for (const TrackedState* state : {&last_, &lost_, &kept_, &frame_}) {
    if (state->images && state->images == latest_images_) return state->edges.get();
  }
  return nullptr;
}

// For so long that the last tracked frame's points are not looked for any more.
bool Tracker::isLost(std::int64_t time_ns) const {
  return !last_.images ||
         (lost_since_ns_ >= 0 && static_cast<double>(time_ns - lost_since_ns_) * 1e-9 > options_.regain_seconds);
}

// The last frame's tracks followed into this one, and its pose from them (P5, P6, P16, P17).
bool Tracker::followAndLocate(StageClock& clock) {
  scratch_.release();
  const FrameImages& from = *last_.images;
  const FrameImages& to = *frame_.images;
  const double scene_depth = medianDepth(last_.tracks, view_, last_.world_T_camera, 1.0, &scratch_);
  const AlignmentPoints points =
      placeTracks(camera_, last_.tracks, view_, last_.world_T_camera, scene_depth, &scratch_);
  const Pose predicted = alignImages(points);
  clock.finished(Stage::alignment);
  const Pixels predictions = predictPixels(camera_, points, last_.world_T_camera, predicted, &scratch_);
  const FlowMatches matches = followPoints(from, to, last_.tracks, predictions, options_.flow, &scratch_);
  filterTracks(from, to, *frame_.edges, last_.tracks, matches, options_.flow, frame_.tracks, &scratch_);
  clock.finished(Stage::flow);

  const FramePose first = estimatePose(camera_, view_, frame_.tracks, predicted, options_.pose, &scratch_);
  if (!first.result.converged) return false;
  clock.finished(Stage::pose);
  refineTracks(camera_, view_, to, first.result.world_T_camera, scene_depth, options_.refinement, frame_.tracks);
  clock.finished(Stage::refinement);
  const FramePose pose =
      estimatePose(camera_, view_, frame_.tracks, first.result.world_T_camera, options_.pose, &scratch_);
  if (!pose.result.converged || pose.result.inlier_count < fewestInliers(pose.track_of_observation.size()))
    return false;
  if (view_.initialised && !(largestDeviation(pose.result.covariance, scene_depth) < options_.largest_deviation)) {
    return false;
  }
  frame_.world_T_camera = pose.result.world_T_camera;
  frame_.covariance = pose.result.covariance;
  frame_.inlier_count = pose.result.inlier_count;
  const auto in_view = static_cast<double>(pose.track_of_observation.size());
  frame_.outlier_share = in_view > 0 ? 1 - frame_.inlier_count / in_view : 0;

  dropOutliers(pose);
  lockAlongEdges(camera_, view_, frame_.world_T_camera, options_.edge_lock, frame_.tracks);
  for (Track& track : frame_.tracks) updateAccuracy(to.pyramid.levels[0], points_, track);
  clock.finished(Stage::pose);
  return true;
}

// The motion since the last frame from the images as a whole: first its rotation, then all of it by the tracks'
// patches.
Pose Tracker::alignImages(const AlignmentPoints& points) {
  const ImagePyramid& from = last_.images->pyramid;
  const ImagePyramid& to = frame_.images->pyramid;
  const Pose by_velocity = predictPose(frame_.images->time_ns).inverse() * last_.world_T_camera;
  const Pose by_rotation{alignRotation(camera_, rotation_grids_, from, to, by_velocity.rotation),
                         by_velocity.translation};
  const Pose to_T_from =
      alignSparsely(camera_, from, to, points, by_rotation, by_velocity, options_.alignment, &scratch_);
  return last_.world_T_camera * to_T_from.inverse();
}

// With fewer of the map points in view a pose is not believed. A flat map fits a scene with depth only here and there:
// before the map stands no share of inliers is asked for.
int Tracker::fewestInliers(std::size_t in_view) const {
  if (!view_.initialised) return 0;
  const auto visible = static_cast<double>(in_view), before = static_cast<double>(last_.inlier_count);
  double fewest = std::max(options_.least_inlier_share * visible, options_.least_points_share * before);
  if (lost_since_ns_ >= 0) {
    const double most_of_them =
        std::max(options_.regain_inlier_share * visible, options_.regain_fewest_points_share * before);
    const double as_many_as_before = options_.regain_points_share * before;
    fewest = std::max(fewest, std::min(most_of_them, as_many_as_before));
  }
  return static_cast<int>(std::ceil(fewest));
}

void Tracker::dropOutliers(const FramePose& pose) {
  std::vector<Track>& tracks = frame_.tracks;
  for (std::size_t i = 0; i < pose.track_of_observation.size(); ++i) {
    Track& track = tracks[static_cast<std::size_t>(pose.track_of_observation[i])];
    track.outlier_frames = pose.result.inliers[i] ? 0 : track.outlier_frames + 1;
  }
  if (!view_.initialised) return;
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) { return track.outlier_frames >= options_.outlier_frames; }),
               tracks.end());
}

void Tracker::reuseMap(TrackedState& frame) {
  scratch_.release();
  reuseMapPoints(camera_, view_, *frame.images, *frame.edges, frame.world_T_camera,
                 static_cast<std::size_t>(options_.points.count), options_.map_reuse, frame.tracks, &scratch_);
}

// Of the keyframe in which most of the points in view are hosted, carried to where the camera is.
Matrix6d Tracker::uncertaintyOfMapAt(const TrackedState& state) {
  scratch_.release();
  std::pmr::vector<int> points_of(view_.keyframes.size(), 0, &scratch_);
  AscendingPoints points(view_);
  std::size_t most = view_.keyframes.size() - 1;
  for (const Track& track : state.tracks) {
    const ViewPoint* point = points.find(track.id);
    if (!point) continue;
    const std::size_t place = view_.keyframes.placeOf(point->host);
    if (++points_of[place] > points_of[most]) most = place;
  }
  const ViewKeyframe& keyframe = view_.keyframes.atPlace(most);
  return carriedUncertainty(keyframe.uncertainty, keyframe.world_T_camera.inverse() * state.world_T_camera)
      .topLeftCorner<6, 6>();
}

// With the map's own uncertainty, of the last pose that was measured.
Matrix6d Tracker::inWorld(const Matrix6d& covariance, double outlier_share) const {
  const double contradiction = 1 + squared(outlier_share / options_.doubling_outlier_share);
  Matrix6d sum = squared(options_.correlation_factor) * contradiction * covariance + map_covariance_;
  sum.diagonal().tail<3>().array() += squared(options_.calibration_sigma / meanFocalLength(camera_));
  return sum;
}

void Tracker::report(bool mapping_busy, TrackingOutcome& outcome) {
  outcome.state = view_.initialised ? FrameState::tracking : FrameState::initialising;
  if (!view_.initialised) outcome.reason = view_.waiting_for;
  outcome.world_T_camera = frame_.world_T_camera;
  outcome.covariance = frame_.covariance;
  if (view_.initialised) {
    map_covariance_ = uncertaintyOfMapAt(frame_);
    outcome.world_covariance = inWorld(frame_.covariance, frame_.outlier_share);
  }
  outcome.reference = view_.keyframes.back().id;
  outcome.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * frame_.world_T_camera;
  outcome.tracked_points = static_cast<int>(frame_.tracks.size());
  outcome.mapped_points = frame_.inlier_count;
  if (view_.initialised || mapping_busy) return;
  outcome.tells_mapping = true;
  describe(frame_, -1, "", outcome.for_mapping);
}

void Tracker::lose(std::int64_t time_ns, const char* reason, TrackingOutcome& outcome) {
  predict(time_ns, reason, outcome);
  outcome.state = FrameState::lost;
  if (lost_since_ns_ < 0) lost_since_ns_ = time_ns;
  std::swap(lost_, frame_);
}

void Tracker::skip(std::int64_t time_ns, const std::string& reason, TrackingOutcome& outcome) const {
  clear(outcome);
  predict(time_ns, reason, outcome);
}

void Tracker::predict(std::int64_t time_ns, std::string_view reason, TrackingOutcome& outcome) const {
  outcome.reason = reason;
  if (!last_.images || !view_.initialised) return;
  outcome.state = FrameState::predicted;
  outcome.world_T_camera = predictPose(time_ns);
  // Hand-held cameras accelerate by some 5 m/s^2 and 10 rad/s^2; lengths are in units of the scene's depth here.
  const double seconds = static_cast<double>(time_ns - last_.images->time_ns) * 1e-9;
  const double translation = 2.0 * seconds * seconds, rotation = 5.0 * seconds * seconds;
  outcome.covariance = last_.covariance;
  outcome.covariance.diagonal().head<3>().array() += translation * translation;
  outcome.covariance.diagonal().tail<3>().array() += rotation * rotation;
  outcome.world_covariance = inWorld(outcome.covariance, last_.outlier_share);
  outcome.reference = view_.keyframes.back().id;
  outcome.reference_T_camera = view_.keyframes.back().world_T_camera.inverse() * outcome.world_T_camera;
}

Pose Tracker::predictPose(std::int64_t time_ns) const {
  if (interval_ns_ <= 0) return last_.world_T_camera;
  // Constant velocity, but not for long: after a gap the camera has rather stopped than flown on.
  const double ahead = static_cast<double>(time_ns - last_.images->time_ns) / static_cast<double>(interval_ns_);
  const double share = std::min(ahead, 3.0);
  const Pose motion{rotationExp(share * rotationLog(last_T_next_.rotation)), share * last_T_next_.translation};
  return last_.world_T_camera * motion;
}

void Tracker::remember() {
  lost_since_ns_ = -1;
  last_T_next_ = last_.world_T_camera.inverse() * frame_.world_T_camera;
  interval_ns_ = frame_.images->time_ns - last_.images->time_ns;
  mapped_at_keyframe_ = std::max(mapped_at_keyframe_, frame_.inlier_count);
  ++frames_since_keyframe_;
  const auto tracks = static_cast<double>(frame_.tracks.size());
  average_tracks_ = average_tracks_ == 0 ? tracks : 0.95 * average_tracks_ + 0.05 * tracks;
  std::swap(last_, frame_);
}

}  // namespace edgeslam
