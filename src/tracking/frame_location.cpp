#include "tracking/frame_location.h"

#include <algorithm>

#include "tracking/measurement_accuracy.h"

namespace edgeslam {

FrameLocation::FrameLocation(const Camera& camera, const LocationOptions& options)
    : camera_(camera), options_(options), rotation_grids_(makeRotationGrids(camera)) {}

bool FrameLocation::locate(const FollowedFrame& last, const MapView& view, const LocationPrior& prior,
                           FollowedFrame& frame, std::pmr::memory_resource& memory, StageClock& clock) const {
  const FrameImages& from = *last.images;
  const FrameImages& to = *frame.images;
  frame.noise = {};
  const double scene_depth = medianDepth(last.tracks, view, last.world_T_camera, 1.0, &memory);
  const AlignmentPoints points = placeTracks(camera_, last.tracks, view, last.world_T_camera, scene_depth, &memory);
  const Pose predicted = alignImages(last, points, prior.world_T_predicted, frame, memory);
  clock.finished(Stage::alignment);

  // P5, P6
  const Pixels predictions = predictPixels(camera_, points, last.world_T_camera, predicted, &memory);
  const FlowMatches matches = followPoints(from, to, last.tracks, predictions, options_.flow, &memory);
  filterTracks(from, to, *frame.edges, last.tracks, matches, options_.flow, frame.tracks, &memory);
  clock.finished(Stage::flow);

  // P16, once more after the points were refined against their keyframes
  const FramePose first = estimatePose(camera_, view, frame.tracks, predicted, options_.pose, &memory, prior.motion);
  if (!first.result.converged) return false;
  clock.finished(Stage::pose);
  refineTracks(camera_, view, to, {first.result.world_T_camera, first.result.twist}, scene_depth, options_.refinement,
               frame.tracks);
  clock.finished(Stage::refinement);
  const FramePose pose =
      estimatePose(camera_, view, frame.tracks, first.result.world_T_camera, options_.pose, &memory, prior.motion);
  // What the points say of the noise they say of a pose that is refused as well: else it could not rise when it
  // matters.
  if (view.initialised) frame.noise = noiseEvidence(pose.result.errors_across, &memory);
  if (!pose.result.converged) return false;
  // A flat map fits a scene with depth only here and there: before the map stands every pose is believed.
  const AcceptanceContext context{last.inlier_count, prior.regains, scene_depth};
  if (view.initialised && !isBelieved(pose, context, options_.acceptance)) return false;

  frame.world_T_camera = pose.result.world_T_camera;
  frame.twist = pose.result.twist;
  frame.covariance = pose.result.covariance;
  frame.inlier_count = pose.result.inlier_count;
  const auto in_view = static_cast<double>(pose.track_of_observation.size());
  frame.outlier_share = in_view > 0 ? 1 - frame.inlier_count / in_view : 0;
  countOutliers(pose, view.initialised, frame.tracks);
  lockAlongEdges(camera_, view, {frame.world_T_camera, frame.twist}, options_.edge_lock, frame.tracks);
  for (Track& track : frame.tracks) updateAccuracy(to.pyramid.levels[0], prior.accuracy, track);
  clock.finished(Stage::pose);
  return true;
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
  const Pose to_T_from =
      alignSparsely(camera_, from, to, points, by_rotation, by_velocity, options_.alignment, &memory);
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
