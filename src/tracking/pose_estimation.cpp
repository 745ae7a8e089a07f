#include "tracking/pose_estimation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/median.h"
#include "geometry/resectioning.h"

namespace edgeslam {
namespace {

// Where fewer of the map points in view agree, something that moves may have drawn the pose to itself ...
constexpr double most_of_them = 0.7;
// ... and another pose is taken if so many times as many agree with it; where hardly more do, it is the same one.
constexpr double clearly_more = 1.2;

// What is seen of a map point, with the uncertainty that its depth adds along the epipolar direction.
PoseObservation observationOf(const Camera& camera, const MapView& view, const ViewPoint& point, const Track& track,
                              const Pose& predicted_T_world) {
  return observeWithDepth(camera, predicted_T_world * view.keyframes[point.host].world_T_camera,
                          {point.host_bearing, point.inverse_depth, point.inverse_depth_sigma},
                          worldPosition(view, point), measurementOf(track));
}

// Of the mapped tracks; 0 where there are none.
double medianInverseDepth(const MapView& view, const std::vector<Track>& tracks, const Pose& camera_T_world,
                          std::pmr::memory_resource* memory) {
  std::pmr::vector<double> values(memory);
  values.reserve(tracks.size());
  AscendingPoints points(view);
  for (const Track& track : tracks) {
    if (const ViewPoint* point = points.find(track.id)) {
      values.push_back(1 / (camera_T_world * worldPosition(view, *point)).norm());
    }
  }
  return values.empty() ? 0 : upperMedian(values);
}

// Tracks that have no depth yet: with one that is little more than a guess, what they measure is where they are across
// the epipolar line of their keyframe.
void addUnmapped(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                 const Pose& camera_T_world, const FramePoseOptions& options, std::pmr::memory_resource* memory,
                 PoseObservations& observations) {
  const double inverse_depth = medianInverseDepth(view, tracks, camera_T_world, memory);
  if (inverse_depth <= 0) return;
  AscendingPoints points(view);
  for (const Track& track : tracks) {
    if (!track.keyframe_images || !view.keyframes.contains(track.keyframe) || points.find(track.id)) continue;
    ViewPoint guessed;
    guessed.host = track.keyframe;
    const Eigen::Vector2d pixel = track.keyframe_pixel.cast<double>();
    guessed.host_bearing =
        rayOfRow(camera, view.keyframes[track.keyframe].twist, pixel.y(), bearing(camera, pixel)).direction;
    guessed.inverse_depth = inverse_depth;
    guessed.inverse_depth_sigma = options.unmapped_depth_sigma * inverse_depth;
    observations.push_back(observationOf(camera, view, guessed, track, camera_T_world));
    Measurement& measurement = observations.back().measurement;
    measurement.sigma_normal *= options.unmapped_weakening;
    measurement.sigma_tangent *= options.unmapped_weakening;
  }
}

}  // namespace

FramePose estimatePose(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                       const Pose& world_T_predicted, const FramePoseOptions& options,
                       std::pmr::memory_resource* memory, const RowMotion& motion) {
  FramePose pose(memory);
  PoseObservations observations(memory);
  observations.reserve(tracks.size());
  pose.track_of_observation.reserve(tracks.size());
  AscendingPoints mapped_points(view);
  const Pose predicted_T_world = world_T_predicted.inverse();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (const ViewPoint* point = mapped_points.find(tracks[i].id)) {
      observations.push_back(observationOf(camera, view, *point, tracks[i], predicted_T_world));
      pose.track_of_observation.push_back(static_cast<int>(i));
    }
  }
  const std::size_t mapped = observations.size();
  if (view.initialised && options.unmapped_depth_sigma > 0) {
    addUnmapped(camera, view, tracks, predicted_T_world, options, memory, observations);
  }
  pose.result = adjustPose(camera, world_T_predicted, observations, options, memory, motion);
  // What is not mapped helps the pose, but says nothing of how much of the map is found again.
  observations.resize(mapped);
  pose.result.inliers.resize(mapped);
  pose.result.errors_across.resize(mapped);
  pose.result.inlier_count = static_cast<int>(std::count(pose.result.inliers.begin(), pose.result.inliers.end(), 1));
  if (pose.result.inlier_count < options.fewest) pose.result.converged = false;
  const auto agree = static_cast<double>(pose.result.inlier_count), visible = static_cast<double>(mapped);
  const bool most_agree = pose.result.converged && agree >= most_of_them * visible;
  if (most_agree || !view.initialised) return pose;

  Vectors3 points(memory), bearings(memory);
  points.reserve(mapped);
  bearings.reserve(mapped);
  for (const PoseObservation& observation : observations) {
    points.push_back(observation.point);
    const Eigen::Vector2d& pixel = observation.measurement.pixel;
    bearings.push_back(rayOfRow(camera, motion.before, pixel.y(), bearing(camera, pixel)).direction);
  }
  const bool half_agree = pose.result.converged && 2 * agree >= visible;
  const ResectioningResult resectioned =
      resectionBySamples(points, bearings, 3.0 / meanFocalLength(camera), /*seed=*/1, half_agree ? 50 : 200, memory);
  if (!resectioned.found) return pose;
  const PoseResult second =
      adjustPose(camera, resectioned.camera_T_world.inverse(), observations, options, memory, motion);
  const double fewest = half_agree ? clearly_more * agree : agree;
  if (second.converged && second.inlier_count > fewest) {
    pose.result = second;
    pose.by_resectioning = true;
  }
  return pose;
}

double largestDeviation(const Matrix6d& covariance, double scene_depth) {
  const auto along_worst = [](const Eigen::Matrix3d& block) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block, Eigen::EigenvaluesOnly).eigenvalues().z());
  };
  return std::max(along_worst(covariance.topLeftCorner<3, 3>()) / scene_depth,
                  along_worst(covariance.bottomRightCorner<3, 3>()));
}

}  // namespace edgeslam
