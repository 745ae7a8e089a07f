#include "tracking/pose_estimation.h"

#include "geometry/resectioning.h"

namespace edgeslam {
namespace {

// What is seen of a map point, with the uncertainty that its depth adds along the epipolar direction.
PoseObservation observationOf(const Camera& camera, const MapView& view, const ViewPoint& point, const Track& track,
                              const Pose& predicted_T_world) {
  PoseObservation observation;
  observation.point = worldPosition(view, point);
  observation.measurement = measurementOf(track);
  const Pose camera_T_host = predicted_T_world * view.keyframes[point.host].world_T_camera;
  const Eigen::Vector3d scaled =
      camera_T_host.rotation * point.host_bearing + point.inverse_depth * camera_T_host.translation;
  if (scaled.z() > 1e-3) {
    Eigen::Matrix<double, 2, 3> jacobian;
    project(camera, scaled, &jacobian);
    const Eigen::Vector2d motion = jacobian * camera_T_host.translation;  // d pixel / d inverse depth
    const double length = motion.norm();
    if (length > 1e-9) {
      observation.depth_sigma_px = length * point.inverse_depth_sigma;
      observation.depth_direction = motion / length;
    }
  }
  return observation;
}

}  // namespace

FramePose estimatePose(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                       const Pose& world_T_predicted, const PoseOptions& options) {
  FramePose pose;
  std::vector<PoseObservation> observations;
  observations.reserve(tracks.size());
  const Pose predicted_T_world = world_T_predicted.inverse();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (const ViewPoint* point = findPoint(view, tracks[i].id)) {
      observations.push_back(observationOf(camera, view, *point, tracks[i], predicted_T_world));
      pose.track_of_observation.push_back(static_cast<int>(i));
    }
  }
  pose.result = adjustPose(camera, world_T_predicted, observations, options);
  const bool trustworthy =
      pose.result.converged && 2 * pose.result.inlier_count >= static_cast<int>(observations.size());
  if (trustworthy || !view.initialised) return pose;

  std::vector<Eigen::Vector3d> points, bearings;
  for (const PoseObservation& observation : observations) {
    points.push_back(observation.point);
    bearings.push_back(bearing(camera, observation.measurement.pixel));
  }
  const ResectioningResult resectioned = resection(points, bearings, 3.0 / meanFocalLength(camera), /*seed=*/1);
  if (!resectioned.found) return pose;
  const PoseResult second = adjustPose(camera, resectioned.camera_T_world.inverse(), observations, options);
  if (second.converged && second.inlier_count > pose.result.inlier_count) {
    pose.result = second;
    pose.by_resectioning = true;
  }
  return pose;
}

}  // namespace edgeslam
