#include "tracking/pose_estimation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/median.h"
#include "geometry/resectioning.h"
#include "tracking/pose_observations.h"

namespace edgeslam {
namespace {

// Where fewer of the map points in view agree, something that moves may have drawn the pose to itself ...
constexpr double most_of_them = 0.7;
// ... and another pose is taken if so many times as many agree with it; where hardly more do, it is the same one.
constexpr double clearly_more = 1.2;

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

}  // namespace

FramePose estimatePose(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                       const Pose& world_T_predicted, const FramePoseOptions& options,
                       std::pmr::memory_resource* memory, const RowMotion& motion, const PosePrior& prior) {
  FramePose pose(memory);
  PoseObservations observations(memory);
  observations.reserve(tracks.size());
  pose.track_of_observation.reserve(tracks.size());
  const Pose predicted_T_world = world_T_predicted.inverse();
  addMapped(camera, view, tracks, predicted_T_world, observations, pose.track_of_observation);
  const std::size_t mapped = observations.size();
  const double inverse_depth = view.initialised ? medianInverseDepth(view, tracks, predicted_T_world, memory) : 0;
  if (inverse_depth > 0 && options.unmapped_depth_sigma > 0) {
    addUnmapped(camera, view, tracks, predicted_T_world,
                {inverse_depth, options.unmapped_depth_sigma * inverse_depth, options.unmapped_weakening, 0},
                observations);
  }
  pose.result = adjustPose(camera, world_T_predicted, observations, options, memory, motion, prior);
  observations.resize(mapped);
  keepMapped(pose);
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

void keepMapped(FramePose& pose) {
  const std::size_t mapped = pose.track_of_observation.size();
  PoseResult& result = pose.result;
  result.inliers.resize(mapped);
  result.errors_across.resize(mapped);
  result.inlier_count = static_cast<int>(std::count(result.inliers.begin(), result.inliers.end(), 1));
}

double largestDeviation(const Matrix6d& covariance, double scene_depth) {
  const auto along_worst = [](const Eigen::Matrix3d& block) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block, Eigen::EigenvaluesOnly).eigenvalues().z());
  };
  return std::max(along_worst(covariance.topLeftCorner<3, 3>()) / scene_depth,
                  along_worst(covariance.bottomRightCorner<3, 3>()));
}

}  // namespace edgeslam
