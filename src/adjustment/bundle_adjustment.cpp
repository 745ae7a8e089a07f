#include "adjustment/bundle_adjustment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adjustment/bundle_minimization.h"

namespace edgeslam {
namespace {

// Inverse depths below 0 are points beyond infinity, where the residual goes on smoothly: they are let through while
// adjusting, and end here.
constexpr double kLeastInverseDepth = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int index) { return static_cast<std::size_t>(index); }

bool finite(const Pose& pose) { return pose.rotation.coeffs().allFinite() && pose.translation.allFinite(); }

bool indicesInRange(const BundleProblem& problem) {
  const int cameras = static_cast<int>(problem.cameras.size()), points = static_cast<int>(problem.points.size());
  if (problem.scale_camera >= cameras) return false;
  for (const BundlePoint& p : problem.points) {
    if (p.host < 0 || p.host >= cameras) return false;
  }
  for (const BundleObservation& o : problem.observations) {
    if (o.camera < 0 || o.camera >= cameras || o.point < 0 || o.point >= points) return false;
  }
  return true;
}

// Errors, depth deviations and robust cost of a problem as it stands.
struct Assessment {
  std::vector<double> errors;
  std::vector<double> depth_sigmas;
  double cost = 0;
};

Assessment assess(const Camera& camera, const BundleProblem& problem, double huber) {
  std::vector<CameraFrame> frames;
  frames.reserve(problem.cameras.size());
  for (const BundleCamera& c : problem.cameras) frames.push_back(cameraFrame(c.world_T_camera));
  Assessment assessment;
  assessment.errors.assign(problem.observations.size(), kInfinity);
  std::vector<double> information(problem.points.size(), 0.0);
  for (std::size_t k = 0; k < problem.observations.size(); ++k) {
    const BundleObservation& o = problem.observations[k];
    const BundlePoint& p = problem.points[at(o.point)];
    if (!usable(p) || !usable(o.measurement)) continue;
    const CameraFrame &host = frames[at(p.host)], &target = frames[at(o.camera)];
    Eigen::Vector2d residual;
    Matrix23d by_sight;
    if (!sightResidual(camera, {o.measurement.pixel, whitening(o.measurement)}, target,
                       sight(host, target, p.host_bearing, p.inverse_depth), residual, &by_sight)) {
      assessment.cost += 0.5 * huberLoss(behind_norm * behind_norm, huber);
      continue;
    }
    const double norm = residual.norm();
    assessment.errors[k] = norm;
    assessment.cost += 0.5 * huberLoss(norm * norm, huber);
    information[at(o.point)] += huberWeight(norm, huber) * (by_sight * (host.centre - target.centre)).squaredNorm();
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const BundlePoint& p = problem.points[i];
    if (usable(p) && p.prior_sigma > 0) {
      const double error = (p.inverse_depth - p.prior_inverse_depth) / p.prior_sigma;
      assessment.cost += 0.5 * error * error;
      information[i] += 1 / (p.prior_sigma * p.prior_sigma);
    }
    assessment.depth_sigmas.push_back(information[i] > 0 ? 1 / std::sqrt(information[i]) : 0);
  }
  return assessment;
}

// Brings the scale camera back to its distance from camera 0 by scaling centres about camera 0 and depths with them,
// which changes no residual but the depth priors'. Where another camera or a point is fixed, that holds the scale
// already. False where the distance has collapsed.
bool keepScale(double distance_before, BundleProblem& problem) {
  const Eigen::Vector3d origin = problem.cameras[0].world_T_camera.translation;
  const double distance = (problem.cameras[at(problem.scale_camera)].world_T_camera.translation - origin).norm();
  const double scale = distance_before / distance;
  if (!(scale > 1e-6 && scale < 1e6)) return false;
  for (std::size_t i = 1; i < problem.cameras.size(); ++i) {
    Eigen::Vector3d& centre = problem.cameras[i].world_T_camera.translation;
    centre = origin + scale * (centre - origin);
  }
  for (BundlePoint& p : problem.points) p.inverse_depth /= scale;
  return true;
}

bool scaleIsFree(const BundleProblem& problem) {
  if (problem.scale_camera < 1) return false;
  const auto fixed_camera = [](const BundleCamera& c) { return c.fixed; };
  const auto fixed_point = [](const BundlePoint& p) { return p.fixed; };
  return std::none_of(problem.cameras.begin() + 1, problem.cameras.end(), fixed_camera) &&
         std::none_of(problem.points.begin(), problem.points.end(), fixed_point);
}

// Copies what was adjusted. False where it holds a value that is not finite.
bool readBack(const BundleStructure& structure, const BundleState& state, BundleProblem& problem) {
  for (const int c : structure.camera_of_unknown) {
    Pose& pose = problem.cameras[at(c)].world_T_camera;
    pose = {state.rotations[at(c)], state.frames[at(c)].centre};
    if (!finite(pose)) return false;
  }
  for (std::size_t i = 0; i < structure.points.size(); ++i) {
    if (!structure.points[i].free) continue;
    if (!std::isfinite(state.inverse_depths[i])) return false;
    problem.points[at(structure.points[i].index)].inverse_depth = std::max(kLeastInverseDepth, state.inverse_depths[i]);
  }
  return true;
}

}  // namespace

BundleResult adjustBundle(const Camera& camera, BundleProblem& problem, const BundleOptions& options) {
  BundleResult result;
  const auto finite_camera = [](const BundleCamera& c) { return finite(c.world_T_camera); };
  if (!indicesInRange(problem) || !std::all_of(problem.cameras.begin(), problem.cameras.end(), finite_camera)) {
    result.errors.assign(problem.observations.size(), kInfinity);
    result.depth_sigmas.assign(problem.points.size(), 0);
    return result;
  }
  Assessment assessment = assess(camera, problem, options.huber);
  result.initial_cost = result.final_cost = assessment.cost;

  BundleWorkspace workspace;
  const int iterations = minimizeBundle(camera, problem, options, workspace);
  BundleProblem adjusted = problem;
  bool usable = iterations >= 0 && readBack(workspace.structure, workspace.state, adjusted);
  if (usable && scaleIsFree(problem)) {
    const double distance = (problem.cameras[at(problem.scale_camera)].world_T_camera.translation -
                             problem.cameras[0].world_T_camera.translation)
                                .norm();
    usable = keepScale(distance, adjusted);
  }
  if (usable) {
    problem = std::move(adjusted);
    assessment = assess(camera, problem, options.huber);
    result.usable = true;
    result.final_cost = assessment.cost;
    result.iterations = iterations;
  }
  result.errors = std::move(assessment.errors);
  result.depth_sigmas = std::move(assessment.depth_sigmas);
  return result;
}

}  // namespace edgeslam
