#include "adjustment/bundle_adjustment.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "adjustment/reprojection.h"

namespace edgeslam {
namespace {

// Whitened norm that an observation behind its camera counts with, without pulling at anything: enough that no step is
// taken for bringing points there, little enough that a single point does not forbid a step.
constexpr double kBehindNorm = 100;
// Inverse depths below 0 are points beyond infinity, where the residual goes on smoothly: they are let through while
// adjusting, and end here.
constexpr double kLeastInverseDepth = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool finite(const Pose& pose) { return pose.rotation.coeffs().allFinite() && pose.translation.allFinite(); }

bool finite(const BundlePoint& p) {
  return p.host_bearing.allFinite() && p.inverse_depth > 0 && std::isfinite(p.inverse_depth) &&
         std::isfinite(p.prior_sigma) && std::isfinite(p.prior_inverse_depth);
}

bool finite(const Measurement& m) {
  return m.pixel.allFinite() && m.normal.allFinite() && m.sigma_normal > 0 && m.sigma_tangent > 0;
}

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

BundleCamera& cameraAt(BundleProblem& problem, int index) { return problem.cameras[static_cast<std::size_t>(index)]; }
const BundleCamera& cameraAt(const BundleProblem& problem, int index) {
  return problem.cameras[static_cast<std::size_t>(index)];
}
const BundlePoint& pointAt(const BundleProblem& problem, int index) {
  return problem.points[static_cast<std::size_t>(index)];
}

// d rotationLog(exp(v)^-1 exp(v + d)) / d d at d = 0: the right Jacobian of SO(3).
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& rotation_vector) {
  const double squared = rotation_vector.squaredNorm(), angle = std::sqrt(squared);
  const Eigen::Matrix3d s = skew(rotation_vector);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() - 0.5 * s + s * s / 6;
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / squared * s +
         (angle - std::sin(angle)) / (squared * angle) * s * s;
}

// What Ceres moves, in plain arrays: of a camera its centre (world frame) and the rotation vector from its first
// orientation; of a point its inverse depth. Six numbers for six unknowns, so that Ceres needs no manifold. What all
// residuals of a camera share is computed once an evaluation, here.
class BundleState final : public ceres::EvaluationCallback {
 public:
  explicit BundleState(const BundleProblem& problem) {
    for (const BundleCamera& c : problem.cameras) {
      const Eigen::Vector3d& t = c.world_T_camera.translation;
      cameras_.push_back({t.x(), t.y(), t.z(), 0, 0, 0});
      starts_.push_back(c.world_T_camera.rotation);
      frames_.push_back(cameraFrame(c.world_T_camera));
      rotation_jacobians_.push_back(Eigen::Matrix3d::Identity());
    }
    for (const BundlePoint& p : problem.points) inverse_depths_.push_back(p.inverse_depth);
  }

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool new_evaluation_point) override {
    if (!new_evaluation_point) return;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const Eigen::Vector3d rotation_vector = Eigen::Map<const Eigen::Vector3d>(&cameras_[i][3]);
      frames_[i] = cameraFrame(pose(i));
      rotation_jacobians_[i] = rightJacobian(rotation_vector);
    }
  }

  Pose pose(std::size_t i) const {
    const Eigen::Map<const Vector6d> p(cameras_[i].data());
    return {(starts_[i] * rotationExp(p.tail<3>())).normalized(), p.head<3>()};
  }
  double inverseDepth(std::size_t i) const { return inverse_depths_[i]; }

  double* cameraParameters(int i) { return cameras_[static_cast<std::size_t>(i)].data(); }
  double* pointParameter(int i) { return &inverse_depths_[static_cast<std::size_t>(i)]; }
  const CameraFrame& frame(int i) const { return frames_[static_cast<std::size_t>(i)]; }

  // From a derivative by the right-hand update [translation; rotation] of a camera to that by its parameters.
  void writeCameraJacobian(int i, const Matrix26d& by_update, double* row_major) const {
    Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> jacobian(row_major);
    jacobian.leftCols<3>().noalias() = by_update.leftCols<3>() * frame(i).world_R_camera.transpose();
    jacobian.rightCols<3>().noalias() = by_update.rightCols<3>() * rotation_jacobians_[static_cast<std::size_t>(i)];
  }

 private:
  std::vector<std::array<double, 6>> cameras_;
  std::vector<double> inverse_depths_;
  std::vector<Eigen::Quaterniond> starts_;
  std::vector<CameraFrame> frames_;
  std::vector<Eigen::Matrix3d> rotation_jacobians_;
};

// An observation's two residuals. Its parameter blocks are those of host, target and point that are free, in this
// order.
class ObservationCost final : public ceres::CostFunction {
 public:
  ObservationCost(const Camera& camera, const BundleProblem& problem, const BundleObservation& observation,
                  const BundleState& state)
      : camera_(camera),
        state_(state),
        bearing_(pointAt(problem, observation.point).host_bearing),
        measured_{observation.measurement.pixel, whitening(observation.measurement)},
        host_(pointAt(problem, observation.point).host),
        target_(observation.camera),
        point_(observation.point),
        host_free_(!cameraAt(problem, host_).fixed),
        target_free_(!cameraAt(problem, target_).fixed),
        point_free_(!pointAt(problem, point_).fixed) {
    set_num_residuals(2);
    if (host_free_) mutable_parameter_block_sizes()->push_back(6);
    if (target_free_) mutable_parameter_block_sizes()->push_back(6);
    if (point_free_) mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals, double** jacobians) const override {
    Eigen::Vector2d residual(kBehindNorm, 0);
    BundleDerivatives derivatives;
    const double inverse_depth = state_.inverseDepth(static_cast<std::size_t>(point_));
    if (!bundleResidual(camera_, measured_, state_.frame(host_), state_.frame(target_), bearing_, inverse_depth,
                        residual, jacobians ? &derivatives : nullptr)) {
      derivatives.by_host.setZero();
      derivatives.by_target.setZero();
      derivatives.by_inverse_depth.setZero();
    }
    residuals[0] = residual.x();
    residuals[1] = residual.y();
    if (!jacobians) return true;
    if (host_free_) state_.writeCameraJacobian(host_, derivatives.by_host, *jacobians++);
    if (target_free_) state_.writeCameraJacobian(target_, derivatives.by_target, *jacobians++);
    if (point_free_) {
      (*jacobians)[0] = derivatives.by_inverse_depth.x();
      (*jacobians)[1] = derivatives.by_inverse_depth.y();
    }
    return true;
  }

 private:
  const Camera& camera_;
  const BundleState& state_;
  Eigen::Vector3d bearing_;
  WhitenedPixel measured_;
  int host_, target_, point_;
  bool host_free_, target_free_, point_free_;
};

// Prior on an inverse depth. The second residual, always 0, keeps all blocks of rows the same size: Ceres' Schur
// complement is faster so.
class DepthPriorCost final : public ceres::SizedCostFunction<2, 1> {
 public:
  explicit DepthPriorCost(const BundlePoint& point) : mean_(point.prior_inverse_depth), sigma_(point.prior_sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = (parameters[0][0] - mean_) / sigma_;
    residuals[1] = 0;
    if (jacobians && jacobians[0]) {
      jacobians[0][0] = 1 / sigma_;
      jacobians[0][1] = 0;
    }
    return true;
  }

 private:
  double mean_, sigma_;
};

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
  assessment.errors.reserve(problem.observations.size());
  std::vector<double> information(problem.points.size(), 0.0);
  for (const BundleObservation& o : problem.observations) {
    const BundlePoint& p = pointAt(problem, o.point);
    Eigen::Vector2d residual;
    BundleDerivatives derivatives;
    if (!finite(p) || !finite(o.measurement)) {
      assessment.errors.push_back(kInfinity);
      continue;
    }
    const WhitenedPixel measured{o.measurement.pixel, whitening(o.measurement)};
    if (!bundleResidual(camera, measured, frames[static_cast<std::size_t>(p.host)],
                        frames[static_cast<std::size_t>(o.camera)], p.host_bearing, p.inverse_depth, residual,
                        &derivatives)) {
      assessment.errors.push_back(kInfinity);
      assessment.cost += 0.5 * huberLoss(kBehindNorm * kBehindNorm, huber);
      continue;
    }
    const double norm = residual.norm();
    assessment.errors.push_back(norm);
    assessment.cost += 0.5 * huberLoss(norm * norm, huber);
    information[static_cast<std::size_t>(o.point)] +=
        huberWeight(norm, huber) * derivatives.by_inverse_depth.squaredNorm();
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const BundlePoint& p = problem.points[i];
    if (finite(p) && p.prior_sigma > 0) {
      const double error = (p.inverse_depth - p.prior_inverse_depth) / p.prior_sigma;
      assessment.cost += 0.5 * error * error;
      information[i] += 1 / (p.prior_sigma * p.prior_sigma);
    }
    assessment.depth_sigmas.push_back(information[i] > 0 ? 1 / std::sqrt(information[i]) : 0);
  }
  return assessment;
}

// The problem as Ceres sees it: only what is free and observed.
struct CeresProblem {
  CeresProblem(const BundleProblem& problem, double huber) : state(problem), loss(huber) {}

  BundleState state;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs;
  ceres::HuberLoss loss;
  std::unique_ptr<ceres::Problem> ceres;
  std::vector<char> camera_used, point_used;
};

std::unique_ptr<CeresProblem> buildCeresProblem(const Camera& camera, const BundleProblem& problem, double huber) {
  auto built = std::make_unique<CeresProblem>(problem, huber);
  built->camera_used.assign(problem.cameras.size(), 0);
  built->point_used.assign(problem.points.size(), 0);
  built->costs.reserve(problem.observations.size());
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  options.evaluation_callback = &built->state;
  built->ceres = std::make_unique<ceres::Problem>(options);

  std::array<double*, 3> blocks;
  for (const BundleObservation& o : problem.observations) {
    const BundlePoint& p = pointAt(problem, o.point);
    if (p.host == o.camera || !finite(p) || !finite(o.measurement)) continue;
    int count = 0;
    for (const int c : {p.host, o.camera}) {
      if (cameraAt(problem, c).fixed) continue;
      built->camera_used[static_cast<std::size_t>(c)] = 1;
      blocks[static_cast<std::size_t>(count++)] = built->state.cameraParameters(c);
    }
    if (!p.fixed) {
      built->point_used[static_cast<std::size_t>(o.point)] = 1;
      blocks[static_cast<std::size_t>(count++)] = built->state.pointParameter(o.point);
    }
    if (count == 0) continue;
    built->costs.push_back(std::make_unique<ObservationCost>(camera, problem, o, built->state));
    built->ceres->AddResidualBlock(built->costs.back().get(), &built->loss, blocks.data(), count);
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    if (!built->point_used[i] || !(problem.points[i].prior_sigma > 0)) continue;
    built->costs.push_back(std::make_unique<DepthPriorCost>(problem.points[i]));
    built->ceres->AddResidualBlock(built->costs.back().get(), nullptr,
                                   built->state.pointParameter(static_cast<int>(i)));
  }
  return built;
}

class GiveUp : public ceres::IterationCallback {
 public:
  explicit GiveUp(const std::atomic<bool>* interrupted) : interrupted_(interrupted) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return interrupted_->load(std::memory_order_relaxed) ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::atomic<bool>* interrupted_;
};

// Points are eliminated first; what is left is a dense system in a local map and a sparse one in a large one.
ceres::Solver::Options solverOptions(CeresProblem& built, const BundleOptions& options) {
  constexpr int kDenseCameras = 30;
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.iterations;
  solver.num_threads = 1;
  solver.function_tolerance = 1e-6;  // outliers inflate the cost that this is relative to
  solver.logging_type = ceres::SILENT;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  int cameras = 0, points = 0;
  for (std::size_t i = 0; i < built.point_used.size(); ++i) {
    if (!built.point_used[i]) continue;
    ordering->AddElementToGroup(built.state.pointParameter(static_cast<int>(i)), 0);
    ++points;
  }
  for (std::size_t i = 0; i < built.camera_used.size(); ++i) {
    if (!built.camera_used[i]) continue;
    ordering->AddElementToGroup(built.state.cameraParameters(static_cast<int>(i)), 1);
    ++cameras;
  }
  if (cameras == 0) {
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  } else if (points == 0) {
    solver.linear_solver_type = cameras <= kDenseCameras ? ceres::DENSE_NORMAL_CHOLESKY : ceres::SPARSE_NORMAL_CHOLESKY;
  } else {
    solver.linear_solver_type = cameras <= kDenseCameras ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    solver.linear_solver_ordering = ordering;
  }
  return solver;
}

// Brings the scale camera back to its distance from camera 0 by scaling centres about camera 0 and depths with them,
// which changes no residual but the depth priors'. Where another camera or a point is fixed, that holds the scale
// already. False where the distance has collapsed.
bool keepScale(double distance_before, BundleProblem& problem) {
  const Eigen::Vector3d origin = cameraAt(problem, 0).world_T_camera.translation;
  const double distance = (cameraAt(problem, problem.scale_camera).world_T_camera.translation - origin).norm();
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
bool readBack(const CeresProblem& built, BundleProblem& problem) {
  for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
    if (!built.camera_used[i]) continue;
    problem.cameras[i].world_T_camera = built.state.pose(i);
    if (!finite(problem.cameras[i].world_T_camera)) return false;
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    if (!built.point_used[i]) continue;
    if (!std::isfinite(built.state.inverseDepth(i))) return false;
    problem.points[i].inverse_depth = std::max(kLeastInverseDepth, built.state.inverseDepth(i));
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

  const std::unique_ptr<CeresProblem> built = buildCeresProblem(camera, problem, options.huber);
  if (built->ceres->NumResidualBlocks() > 0) {
    ceres::Solver::Summary summary;
    ceres::Solver::Options solver = solverOptions(*built, options);
    GiveUp give_up(options.interrupted);
    if (options.interrupted) solver.callbacks.push_back(&give_up);
    ceres::Solve(solver, built->ceres.get(), &summary);
    BundleProblem adjusted = problem;
    bool usable = summary.IsSolutionUsable() && readBack(*built, adjusted);
    if (usable && scaleIsFree(problem)) {
      const double distance = (cameraAt(problem, problem.scale_camera).world_T_camera.translation -
                               cameraAt(problem, 0).world_T_camera.translation)
                                  .norm();
      usable = keepScale(distance, adjusted);
    }
    if (usable) {
      problem = std::move(adjusted);
      assessment = assess(camera, problem, options.huber);
      result.usable = true;
      result.final_cost = assessment.cost;
      result.iterations = static_cast<int>(summary.iterations.size()) - 1;
    }
  }
  result.errors = std::move(assessment.errors);
  result.depth_sigmas = std::move(assessment.depth_sigmas);
  return result;
}

}  // namespace edgeslam
