#include "tracking/pose_observations.h"

#include <cmath>

namespace edgeslam {
namespace {

// What is seen of a point, with the uncertainty that its depth adds along the epipolar direction.
PoseObservation observationOf(const Camera& camera, const MapView& view, const ViewPoint& point, const Track& track,
                              const Pose& camera_T_world) {
  return observeWithDepth(camera, camera_T_world * view.keyframes[point.host].world_T_camera,
                          {point.host_bearing, point.inverse_depth, point.inverse_depth_sigma},
                          worldPosition(view, point), measurementOf(track));
}

}  // namespace

void addMapped(const Camera& camera, const MapView& view, const std::vector<Track>& tracks, const Pose& camera_T_world,
               PoseObservations& observations, std::pmr::vector<int>& track_of_observation) {
  AscendingPoints points(view);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const ViewPoint* point = points.find(tracks[i].id);
    if (!point) continue;
    observations.push_back(observationOf(camera, view, *point, tracks[i], camera_T_world));
    track_of_observation.push_back(static_cast<int>(i));
  }
}

void addUnmapped(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                 const Pose& camera_T_world, const UnmappedTracks& presumed, PoseObservations& observations) {
  AscendingPoints points(view);
  for (const Track& track : tracks) {
    if (!track.keyframe_images || !view.keyframes.contains(track.keyframe) || points.find(track.id)) continue;
    ViewPoint guessed;
    guessed.host = track.keyframe;
    const Eigen::Vector2d pixel = track.keyframe_pixel.cast<double>();
    guessed.host_bearing =
        rayOfRow(camera, view.keyframes[track.keyframe].twist, pixel.y(), bearing(camera, pixel)).direction;
    guessed.inverse_depth = presumed.inverse_depth;
    guessed.inverse_depth_sigma = presumed.inverse_depth_sigma;
    observations.push_back(observationOf(camera, view, guessed, track, camera_T_world));
    Measurement& measurement = observations.back().measurement;
    for (double* sigma : {&measurement.sigma_normal, &measurement.sigma_tangent}) {
      *sigma = presumed.weakening * *sigma;
      if (presumed.parallax_px > 0) *sigma = std::hypot(*sigma, presumed.parallax_px);
    }
  }
}

}  // namespace edgeslam
