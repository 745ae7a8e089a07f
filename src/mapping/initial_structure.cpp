#include "mapping/initial_structure.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "adjustment/bundle_adjustment.h"
#include "adjustment/pose_adjustment.h"
#include "mapping/points_seen_by_both.h"

namespace edgeslam {
namespace {

// Camera 0 is the first frame, camera k + 1 the start's k-th; a point has the index that it has in the first frame.
BundleProblem bundleProblem(const Camera& camera, const InitialFrames& frames, const InitialStart& start,
                            double prior_sigma) {
  BundleProblem problem;
  problem.cameras.push_back({Pose(), true, frames.first.twist});
  for (std::size_t k = 0; k < start.frames.size(); ++k) {
    problem.cameras.push_back({start.first_T_camera[k], false, frames.since[start.frames[k]].twist});
  }
  for (std::size_t i = 0; i < frames.first.observations.size(); ++i) {
    BundlePoint point;
    point.host_bearing = frames.first.observations[i].bearing;
    point.host_origin = rayOrigin(camera, frames.first, frames.first.observations[i]);
    point.inverse_depth = start.inverse_depths[i] > 0 ? start.inverse_depths[i] : 1.0;
    point.prior_sigma = prior_sigma;
    problem.points.push_back(point);
  }
  for (std::size_t k = 0; k < start.frames.size(); ++k) {
    const TrackedFrame& frame = frames.since[start.frames[k]];
    forEachCommon(frames.first, frame, [&](std::size_t i, std::size_t j) {
      problem.observations.push_back({static_cast<int>(k) + 1, static_cast<int>(i), frame.observations[j].measurement});
    });
  }
  return problem;
}

// `errors`: of the problem's observations, whitened.
BundleProblem withoutOutliers(const BundleProblem& problem, const std::vector<double>& errors, double outlier) {
  BundleProblem inliers = problem;
  inliers.observations.clear();
  for (std::size_t k = 0; k < problem.observations.size(); ++k) {
    if (errors[k] < outlier) inliers.observations.push_back(problem.observations[k]);
  }
  return inliers;
}

// Mean over all observations, also those that the adjustment left out: it must not look good by having many outliers.
double boundedError(const Camera& camera, const BundleProblem& adjusted,
                    const std::vector<BundleObservation>& observations, double outlier) {
  const double bound = outlier * outlier;
  double sum = 0;
  for (const BundleObservation& observation : observations) {
    const BundlePoint& point = adjusted.points[static_cast<std::size_t>(observation.point)];
    const BundleCamera& seen_by = adjusted.cameras[static_cast<std::size_t>(observation.camera)];
    const Pose camera_T_first =
        worldTRow(camera, {seen_by.world_T_camera, seen_by.twist}, observation.measurement.pixel.y()).inverse();
    const Eigen::Vector3d seen =
        camera_T_first.rotation * point.host_bearing + point.inverse_depth * (camera_T_first * point.host_origin);
    if (!(seen.z() > 0)) {
      sum += bound;
      continue;
    }
    const Measurement& measurement = observation.measurement;
    sum += std::min(bound, (whitening(measurement) * (project(camera, seen) - measurement.pixel)).squaredNorm());
  }
  return sum / std::max<double>(1, static_cast<double>(observations.size()));
}

}  // namespace

std::optional<InitialStructure> adjustInitialStructure(const Camera& camera, const InitialFrames& frames,
                                                       InitialStart start, const InitialisationOptions& options) {
  assert(start.first_T_camera.size() == start.frames.size());
  assert(start.inverse_depths.size() == frames.first.observations.size());
  BundleProblem problem = bundleProblem(camera, frames, start, options.prior_sigma);
  BundleResult result = adjustBundle(camera, problem, options.bundle);
  if (!result.usable) return std::nullopt;

  // A second round without the outliers: sliding points would bend the start.
  BundleProblem inliers = withoutOutliers(problem, result.errors, options.outlier);
  result = adjustBundle(camera, inliers, options.bundle);
  if (!result.usable) return std::nullopt;

  InitialStructure structure{std::move(start), std::move(result.depth_sigmas),
                             boundedError(camera, inliers, problem.observations, options.outlier)};
  for (std::size_t k = 0; k < structure.frames.size(); ++k)
    structure.first_T_camera[k] = inliers.cameras[k + 1].world_T_camera;
  std::vector<char> seen(inliers.points.size(), 0);
  for (std::size_t k = 0; k < inliers.observations.size(); ++k) {
    if (result.errors[k] < options.outlier) seen[static_cast<std::size_t>(inliers.observations[k].point)] = 1;
  }
  for (std::size_t i = 0; i < inliers.points.size(); ++i) {
    structure.inverse_depths[i] = inliers.points[i].inverse_depth;
    if (!seen[i]) structure.depth_sigmas[i] = options.prior_sigma;
  }
  return structure;
}

Eigen::Vector3d rayOrigin(const Camera& camera, const TrackedFrame& first, const PointObservation& point) {
  return rowPose(camera, first.twist, point.measurement.pixel.y()).translation;
}

std::optional<Pose> locateAgainst(const Camera& camera, const TrackedFrame& first,
                                  const std::vector<double>& inverse_depths, const TrackedFrame& frame,
                                  const Pose& near) {
  assert(inverse_depths.size() == first.observations.size());
  PoseObservations observations;
  forEachCommon(first, frame, [&](std::size_t i, std::size_t j) {
    if (inverse_depths[i] <= 0) return;
    PoseObservation observation;
    observation.point =
        rayOrigin(camera, first, first.observations[i]) + first.observations[i].bearing / inverse_depths[i];
    observation.measurement = frame.observations[j].measurement;
    observations.push_back(observation);
  });
  RowMotion motion;
  motion.before = frame.twist;
  const PoseResult result =
      adjustPose(camera, near, observations, PoseOptions(), std::pmr::get_default_resource(), motion);
  if (!result.converged) return std::nullopt;
  return result.world_T_camera;
}

}  // namespace edgeslam
