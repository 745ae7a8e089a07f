#include "adjustment/bundle_adjustment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adjustment/bundle_inertia.h"
#include "adjustment/bundle_lines.h"
#include "adjustment/bundle_minimization.h"
#include "adjustment/index.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

// Inverse depths below 0 are points beyond infinity, where the residual goes on smoothly: they are let through while
// adjusting, and end here.
constexpr double least_inverse_depth = 1e-6;
// Share by which the scale camera may differ from the others that hold the scale.
constexpr double largest_scale_difference = 0.02;
constexpr double infinity = std::numeric_limits<double>::infinity();

bool indicesInRange(const BundleProblem& problem) {
  const int cameras = static_cast<int>(problem.cameras.size()), points = static_cast<int>(problem.points.size());
  const int lines = static_cast<int>(problem.lines.size());
  if (problem.scale_camera >= cameras) return false;
  const auto inRange = [&](int camera) { return camera >= 0 && camera < cameras; };
  if (!std::all_of(problem.scale_cameras.begin(), problem.scale_cameras.end(), inRange)) return false;
  for (const BundlePoint& p : problem.points) {
    if (p.host < 0 || p.host >= cameras) return false;
  }
  for (const BundleObservation& o : problem.observations) {
    if (o.camera < 0 || o.camera >= cameras || o.point < 0 || o.point >= points) return false;
  }
  for (const BundleLineObservation& o : problem.line_observations) {
    if (o.camera < 0 || o.camera >= cameras || o.line < 0 || o.line >= lines) return false;
  }
  for (const BundleTurn& t : problem.turns) {
    if (!inRange(t.first) || !inRange(t.second)) return false;
  }
  for (const BundleSpeedChange& c : problem.speed_changes) {
    if (!std::all_of(c.cameras.begin(), c.cameras.end(), inRange)) return false;
  }
  for (const BundleWay& w : problem.ways) {
    if (!inRange(w.first) || !inRange(w.second)) return false;
  }
  return true;
}

// Calls function(index, residual or null where behind the camera, its derivative by the sight, baseline) for every
// observation with usable values. The derivative is computed where `derivatives`.
template <typename Function>
void forEachResidual(const Camera& camera, const BundleProblem& problem, bool derivatives, const Function& function) {
  std::vector<CameraFrame> frames;
  frames.reserve(problem.cameras.size());
  for (const BundleCamera& c : problem.cameras) frames.push_back(cameraFrame(c.world_T_camera));
  for (std::size_t k = 0; k < problem.observations.size(); ++k) {
    const BundleObservation& o = problem.observations[k];
    const BundlePoint& p = problem.points[at(o.point)];
    if (!usable(p) || !usable(o.measurement)) continue;
    CameraFrame host = frames[at(p.host)], target = frames[at(o.camera)];
    host.centre += host.world_R_camera * p.host_origin;
    const Twist& twist = problem.cameras[at(o.camera)].twist;
    if (camera.readout_s != 0 && !twist.isZero(0)) {
      target = rowFrame(target, cameraFrame(rowPose(camera, twist, o.measurement.pixel.y())));
    }
    Eigen::Vector2d residual;
    Matrix23d by_sight = Matrix23d::Zero();
    const bool seen = sightResidual(camera, {o.measurement.pixel, whitening(o.measurement)}, target,
                                    sight(host, target, p.host_bearing, p.inverse_depth), residual,
                                    derivatives ? &by_sight : nullptr);
    function(k, seen ? &residual : nullptr, by_sight, host.centre - target.centre);
  }
}

double priorCost(const BundleProblem& problem) {
  double cost = 0;
  for (const BundlePoint& p : problem.points) {
    if (!usable(p) || !(p.prior_sigma > 0)) continue;
    const double error = (p.inverse_depth - p.prior_inverse_depth) / p.prior_sigma;
    cost += 0.5 * error * error;
  }
  return cost;
}

double robustCost(const Camera& camera, const BundleProblem& problem, double huber) {
  double cost = 0;
  forEachResidual(camera, problem, false,
                  [&](std::size_t, const Eigen::Vector2d* residual, const Matrix23d&, const Eigen::Vector3d&) {
                    cost += 0.5 * huberLoss(residual ? residual->squaredNorm() : behind_norm * behind_norm, huber);
                  });
  return cost + priorCost(problem) + lineCost(camera, problem, huber) + inertialCost(problem, huber);
}

// Errors, uncertainties and final cost of a problem as it stands.
void assess(const Camera& camera, const BundleProblem& problem, double huber, BundleResult& result) {
  result.errors.assign(problem.observations.size(), infinity);
  std::vector<double> information(problem.points.size(), 0.0);
  double cost = 0;
  forEachResidual(
      camera, problem, true,
      [&](std::size_t k, const Eigen::Vector2d* residual, const Matrix23d& by_sight, const Eigen::Vector3d& baseline) {
        const double norm = residual ? residual->norm() : behind_norm;
        cost += 0.5 * huberLoss(norm * norm, huber);
        if (!residual) return;
        result.errors[k] = norm;
        information[at(problem.observations[k].point)] +=
            huberWeight(norm, huber) * (by_sight * baseline).squaredNorm();
      });
  result.final_cost = cost + priorCost(problem) + lineCost(camera, problem, huber) + inertialCost(problem, huber);
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const BundlePoint& p = problem.points[i];
    if (usable(p) && p.prior_sigma > 0) information[i] += 1 / (p.prior_sigma * p.prior_sigma);
    result.depth_sigmas.push_back(information[i] > 0 ? 1 / std::sqrt(information[i]) : 0);
  }
  assessLines(camera, problem, huber, result);
}

// How many times as far from camera 0 the scale camera was, or, where the median of those that hold the scale beside it
// says otherwise, that. 0 where they have collapsed.
double scaleToKeep(const std::vector<BundleCamera>& before, const BundleProblem& problem) {
  const auto ratio = [&](int camera) {
    const auto distance = [&](const std::vector<BundleCamera>& cameras) {
      return (cameras[at(camera)].world_T_camera.translation - cameras[0].world_T_camera.translation).norm();
    };
    const double now = distance(problem.cameras);
    return now > 0 ? distance(before) / now : 0.0;
  };
  std::vector<double> ratios;
  for (const int camera : problem.scale_cameras) ratios.push_back(ratio(camera));
  const double own = ratio(problem.scale_camera), median = medianOr(own, ratios);
  return std::abs(own - median) > largest_scale_difference * median ? median : own;
}

// Brings the cameras back to their distance from camera 0 by scaling centres and lines about it and depths with them
// and their priors, which changes no residual. Where another camera, a point or a line is fixed, that holds the scale
// already. False where the distance has collapsed.
bool keepScale(const std::vector<BundleCamera>& before, BundleProblem& problem) {
  const Eigen::Vector3d origin = problem.cameras[0].world_T_camera.translation;
  const double scale = scaleToKeep(before, problem);
  if (!(scale > 1e-6 && scale < 1e6)) return false;
  for (std::size_t i = 1; i < problem.cameras.size(); ++i) {
    Eigen::Vector3d& centre = problem.cameras[i].world_T_camera.translation;
    centre = origin + scale * (centre - origin);
  }
  for (BundleLine& l : problem.lines) l.line.point = origin + scale * (l.line.point - origin);
  for (BundleCamera& c : problem.cameras) c.twist.head<3>() *= scale;
  if (problem.inertia.is_free) problem.inertia.metres_a_unit /= scale;
  for (BundlePoint& p : problem.points) {
    p.inverse_depth /= scale;
    p.prior_inverse_depth /= scale;
    p.prior_sigma /= scale;
    p.host_origin *= scale;
  }
  return true;
}

bool scaleIsFree(const BundleProblem& problem) {
  if (problem.scale_camera < 1) return false;
  const auto fixed_camera = [](const BundleCamera& c) { return c.fixed; };
  const auto fixed_point = [](const BundlePoint& p) { return p.fixed; };
  const auto fixed_line = [](const BundleLine& l) { return l.fixed; };
  return std::none_of(problem.cameras.begin() + 1, problem.cameras.end(), fixed_camera) &&
         std::none_of(problem.points.begin(), problem.points.end(), fixed_point) &&
         std::none_of(problem.lines.begin(), problem.lines.end(), fixed_line);
}

// Copies what was adjusted. False where it holds a value that is not finite.
bool readBack(const BundleStructure& structure, const BundleState& state, BundleProblem& problem) {
  for (const int c : structure.camera_of_unknown) {
    Pose& pose = problem.cameras[at(c)].world_T_camera;
    pose = {state.rotations[at(c)], state.frames[at(c)].centre};
    if (!isFinite(pose)) return false;
  }
  for (std::size_t i = 0; i < structure.points.size(); ++i) {
    if (!structure.points[i].free) continue;
    if (!std::isfinite(state.inverse_depths[i])) return false;
    problem.points[at(structure.points[i].index)].inverse_depth =
        std::max(least_inverse_depth, state.inverse_depths[i]);
  }
  for (std::size_t i = 0; i < structure.lines.size(); ++i) {
    if (!structure.lines[i].free) continue;
    const SpaceLine& line = state.lines[i];
    if (!line.point.allFinite() || !line.direction.allFinite()) return false;
    problem.lines[at(structure.lines[i].index)].line = line;
  }
  if (problem.inertia.is_free) problem.inertia = state.inertia;
  return std::isfinite(problem.inertia.metres_a_unit) && problem.inertia.bias_change.allFinite();
}

}  // namespace

BundleResult adjustBundle(const Camera& camera, BundleProblem& problem, const BundleOptions& options,
                          const std::atomic<bool>* interrupted) {
  BundleResult result;
  const auto finite_camera = [](const BundleCamera& c) { return isFinite(c.world_T_camera) && c.twist.allFinite(); };
  if (!indicesInRange(problem) || !std::all_of(problem.cameras.begin(), problem.cameras.end(), finite_camera)) {
    result.errors.assign(problem.observations.size(), infinity);
    result.depth_sigmas.assign(problem.points.size(), 0);
    result.line_errors.assign(problem.line_observations.size(), infinity);
    result.line_covariances.assign(problem.lines.size(), Eigen::Matrix4d::Zero());
    return result;
  }
  result.initial_cost = robustCost(camera, problem, options.huber);

  BundleWorkspace workspace;
  const int iterations = minimizeBundle(camera, problem, options, interrupted, workspace);
  if (iterations >= 0) {
    const std::vector<BundleCamera> cameras_before = problem.cameras;
    const std::vector<BundlePoint> points_before = problem.points;
    const std::vector<BundleLine> lines_before = problem.lines;
    const BundleInertia inertia_before = problem.inertia;
    result.usable = readBack(workspace.structure, workspace.state, problem) &&
                    (!scaleIsFree(problem) || keepScale(cameras_before, problem));
    if (result.usable) {
      result.iterations = iterations;
      if (problem.inertia.is_free) result.inertia_covariance = workspace.solver.inertiaCovariance();
    } else {
      problem.cameras = cameras_before;
      problem.points = points_before;
      problem.lines = lines_before;
      problem.inertia = inertia_before;
    }
  }
  assess(camera, problem, options.huber, result);
  return result;
}

}  // namespace edgeslam
