#include "tracking/frame_location.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/camera_mask.h"
#include "tracking/measurement_accuracy.h"

namespace edgeslam {
namespace {

// In thousandths, as "0.034".
void append(double share, std::string& text) {
  const auto thousandths = static_cast<int>(std::lround(1000 * std::clamp(share, 0.0, 0.999)));
  text += "0.";
  text += static_cast<char>('0' + thousandths / 100);
  text += static_cast<char>('0' + thousandths / 10 % 10);
  text += static_cast<char>('0' + thousandths % 10);
}

// Measured on that level of the pyramid.
void countForLess(int level, std::vector<Track>& tracks) {
  for (Track& track : tracks) {
    track.sigma_normal = std::ldexp(track.sigma_normal, level);
    track.sigma_tangent = std::ldexp(track.sigma_tangent, level);
  }
}

}  // namespace

// Piece by piece: on the way from a frame to its pose there is no allocation.
void describe(const LocationFigures& figures, std::string& reason) {
  reason.assign("map points not found again: ");
  if (figures.tracks == 0) {
    reason.append("the last frame with a pose is too long ago");
  } else if (!figures.has_pose) {
    reason.append(std::to_string(figures.followed)).append(" of ").append(std::to_string(figures.tracks));
    reason.append(" tracks followed, too few of them in the map");
  } else if (figures.agree < figures.asked) {
    reason.append(std::to_string(figures.agree)).append(" of ").append(std::to_string(figures.in_view));
    reason.append(" in view agree, ").append(std::to_string(figures.asked)).append(" asked for");
  } else if (figures.is_leap) {
    reason.append("the camera leapt, and ").append(std::to_string(figures.followed)).append(" of ");
    reason.append(std::to_string(figures.tracks)).append(" tracks followed are too few to tell where to");
  } else {
    reason.append("the pose is uncertain by ");
    append(figures.deviation, reason);
    reason.append(", allowed are ");
    append(figures.most_allowed, reason);
  }
}

void FrameLocation::setCamera(const Camera& camera) {
  const bool has_other_rays = camera.fx != camera_.fx || camera.fy != camera_.fy;
  camera_ = camera;
  if (has_other_rays) renewRotationGrids(camera, rotation_grids_);
}

FrameLocation::FrameLocation(const Camera& camera, const LocationOptions& options)
    : camera_(camera), options_(options), rotation_grids_(makeRotationGrids(camera)) {
  if (!camera.mask) return;
  const cv::Mat& masked = camera.mask->masked;
  hidden_from_alignment_ = hiddenLevels(masked, options.alignment.coarsest_level + 1, alignment_reach);
  hidden_from_flow_ = hiddenLevels(masked, options.flow.levels, flowReach(options.flow));
}

bool FrameLocation::locate(const FollowedFrame& last, const MapView& view, const LocationPrior& prior,
                           FollowedFrame& frame, LocationFigures& figures, std::pmr::memory_resource& memory,
                           StageClock& clock) const {
  const FrameImages& from = *last.images;
  const FrameImages& to = *frame.images;
  frame.noise = {};
  frame.known = prior.known;
  frame.scene_depth = medianDepth(last.tracks, view, last.world_T_camera, last.scene_depth, &memory);
  const AlignmentPoints points =
      placeTracks(camera_, last.tracks, view, last.world_T_camera, frame.scene_depth, &memory);
  const Pose predicted = alignImages(last, points, prior.world_T_predicted, frame, memory);
  clock.finished(Stage::alignment);

  // P5, P6
  const Pixels predictions = predictPixels(camera_, points, last.world_T_camera, predicted, &memory);
  FlowOptions flow = options_.flow;
  if (prior.coarsely) flow.finest_level = options_.coarse_level;
  const FlowMatches matches = followPoints(from, to, last.tracks, predictions, flow, &memory, hidden_from_flow_);
  filterTracks(from, to, *frame.edges, last.tracks, matches, flow, frame.tracks, &memory);
  if (prior.coarsely) countForLess(options_.coarse_level, frame.tracks);
  clock.finished(Stage::flow);

  figures = {};
  figures.followed = static_cast<int>(frame.tracks.size());
  figures.tracks = static_cast<int>(last.tracks.size());
  const double followed_share = figures.followed / std::max(1.0, static_cast<double>(figures.tracks));
  const double seconds = static_cast<double>(to.time_ns - from.time_ns) * 1e-9;
  const AcceptanceContext context{last.inlier_count, prior.regains,           prior.knows_motion, frame.scene_depth,
                                  seconds,           prior.world_T_predicted, followed_share};
  std::optional<FramePose> pose = poseInMap(view, prior, predicted, context, frame, figures, memory, clock);
  frame.position_is_held = !pose;
  if (!pose && view.initialised && !figures.is_leap && !prior.coarsely) {
    const HeldCamera held{last.world_T_camera, last.covariance,    seconds,
                          followed_share,      predicted.rotation, frame.scene_depth};
    pose = orientationOnly(camera_, view, frame.tracks, held, options_.pose, options_.orientation_only, &memory,
                           prior.motion);
  }
  if (!pose) return false;

  frame.world_T_camera = pose->result.world_T_camera;
  frame.twist = pose->result.twist;
  frame.covariance = pose->result.covariance;
  frame.seen_turn.setZero();
  if (!frame.position_is_held) frame.seen_turn = pose->result.without_prior.tail<3>();
  frame.inlier_count = pose->result.inlier_count;
  // Of the few map points that a held position leaves in view, the share says nothing.
  const auto in_view = frame.position_is_held ? 0 : static_cast<double>(pose->track_of_observation.size());
  frame.outlier_share = in_view > 0 ? 1 - frame.inlier_count / in_view : 0;
  countOutliers(*pose, view.initialised, frame.tracks);
  if (!prior.coarsely) {
    if (!frame.position_is_held) {
      lockAlongEdges(camera_, view, {frame.world_T_camera, frame.twist}, options_.edge_lock, frame.tracks);
    }
    for (Track& track : frame.tracks) updateAccuracy(to.pyramid.levels[0], prior.accuracy, track);
  }
  clock.finished(Stage::pose);
  return true;
}

// P16, once more after the points were refined against their keyframes. Nothing where the map does not tell the pose.
std::optional<FramePose> FrameLocation::poseInMap(const MapView& view, const LocationPrior& prior,
                                                  const Pose& world_T_predicted, const AcceptanceContext& context,
                                                  FollowedFrame& frame, LocationFigures& figures,
                                                  std::pmr::memory_resource& memory, StageClock& clock) const {
  const FramePose first =
      estimatePose(camera_, view, frame.tracks, world_T_predicted, options_.pose, &memory, prior.motion, prior.known);
  if (!first.result.converged) return std::nullopt;
  clock.finished(Stage::pose);
  if (!prior.coarsely) {
    refineTracks(camera_, view, *frame.images, {first.result.world_T_camera, first.result.twist}, context.scene_depth,
                 options_.refinement, frame.tracks);
  }
  clock.finished(Stage::refinement);
  FramePose pose = estimatePose(camera_, view, frame.tracks, first.result.world_T_camera, options_.pose, &memory,
                                prior.motion, prior.known);
  figures.in_view = static_cast<int>(pose.track_of_observation.size());
  figures.agree = pose.result.inlier_count;
  figures.asked = fewestInliers(pose.track_of_observation.size(), context, options_.acceptance);
  // What the points say of the noise they say of a pose that is refused as well: else it could not rise when it
  // matters.
  if (view.initialised && !prior.coarsely) frame.noise = noiseEvidence(pose.result.errors_across, &memory);
  if (!pose.result.converged) return std::nullopt;
  figures.has_pose = true;
  figures.deviation = largestDeviation(pose.result.covariance, context.scene_depth);
  figures.most_allowed = options_.acceptance.largest_deviation;
  figures.is_leap = isLeap(pose, context, options_.acceptance);
  // A flat map fits a scene with depth only here and there: before the map stands every pose is believed.
  if (view.initialised && !isBelieved(pose, context, options_.acceptance)) return std::nullopt;
  return std::optional<FramePose>(std::move(pose));
}

// The motion since the last frame from the images as a whole: first its rotation, then all of it by the tracks'
// patches.
Pose FrameLocation::alignImages(const FollowedFrame& last, const AlignmentPoints& points, const Pose& world_T_predicted,
                                const FollowedFrame& frame, std::pmr::memory_resource& memory) const {
  const ImagePyramid& from = last.images->pyramid;
  const ImagePyramid& to = frame.images->pyramid;
  const Pose by_velocity = world_T_predicted.inverse() * last.world_T_camera;
  const Pose by_rotation{alignRotation(camera_, rotation_grids_, from, to, by_velocity.rotation),
                         by_velocity.translation};
  const Pose to_T_from = alignSparsely(camera_, from, to, points, by_rotation, by_velocity, options_.alignment, &memory,
                                       hidden_from_alignment_);
  return last.world_T_camera * to_T_from.inverse();
}

// Once the map stands, a track that misses the pose again and again is dropped.
void FrameLocation::countOutliers(const FramePose& pose, bool map_stands, std::vector<Track>& tracks) const {
  for (std::size_t i = 0; i < pose.track_of_observation.size(); ++i) {
    Track& track = tracks[static_cast<std::size_t>(pose.track_of_observation[i])];
    track.outlier_frames = pose.result.inliers[i] ? 0 : track.outlier_frames + 1;
  }
  if (!map_stands) return;
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) { return track.outlier_frames >= options_.outlier_frames; }),
               tracks.end());
}

}  // namespace edgeslam
