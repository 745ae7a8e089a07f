#include "ceres_bundle_adjustment.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "adjustment/bundle_linearization.h"

namespace edgeslam::test {
namespace {

// Inverse depths below 0 are points beyond infinity, where the residual goes on smoothly: they are let through while
// adjusting, and end here.
constexpr double least_inverse_depth = 1e-6;

bool finite(const Pose& pose) { return pose.rotation.coeffs().allFinite() && pose.translation.allFinite(); }

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
class CeresState final : public ceres::EvaluationCallback {
 public:
  explicit CeresState(const BundleProblem& problem) {
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

  // From derivatives by a camera's centre and by a turn of it in the world's axes to that by its parameters.
  void writeCameraJacobian(int i, const Matrix23d& by_centre, const Matrix23d& by_turn, double* row_major) const {
    Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> jacobian(row_major);
    jacobian.leftCols<3>() = by_centre;
    jacobian.rightCols<3>().noalias() =
        by_turn * frame(i).world_R_camera * rotation_jacobians_[static_cast<std::size_t>(i)];
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
                  const CeresState& state)
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
    Eigen::Vector2d residual(behind_norm, 0);
    const double inverse_depth = state_.inverseDepth(static_cast<std::size_t>(point_));
    const CameraFrame &host = state_.frame(host_), &target = state_.frame(target_);
    const Eigen::Vector3d seen = sight(host, target, bearing_, inverse_depth);
    Matrix23d by_sight;
    if (!sightResidual(camera_, measured_, target, seen, residual, jacobians ? &by_sight : nullptr)) by_sight.setZero();
    residuals[0] = residual.x();
    residuals[1] = residual.y();
    if (!jacobians) return true;
    const Eigen::Vector3d ray = host.world_R_camera * bearing_;
    if (host_free_) state_.writeCameraJacobian(host_, inverse_depth * by_sight, -by_sight * skew(ray), *jacobians++);
    if (target_free_)
      state_.writeCameraJacobian(target_, -inverse_depth * by_sight, by_sight * skew(seen), *jacobians++);
    if (point_free_) {
      Eigen::Map<Eigen::Vector2d> by_inverse_depth(*jacobians);
      by_inverse_depth.noalias() = by_sight * (host.centre - target.centre);
    }
    return true;
  }

 private:
  const Camera& camera_;
  const CeresState& state_;
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

// The problem as Ceres sees it: only what is free and observed.
struct CeresProblem {
  CeresProblem(const BundleProblem& problem, double huber) : state(problem), loss(huber) {}

  CeresState state;
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
    if (p.host == o.camera || !usable(p) || !usable(o.measurement)) continue;
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

// Points are eliminated first; what is left is a dense system in a local map and a sparse one in a large one.
ceres::Solver::Options solverOptions(CeresProblem& built, const BundleOptions& options) {
  constexpr int dense_cameras = 30;
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
    solver.linear_solver_type = cameras <= dense_cameras ? ceres::DENSE_NORMAL_CHOLESKY : ceres::SPARSE_NORMAL_CHOLESKY;
  } else {
    solver.linear_solver_type = cameras <= dense_cameras ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    solver.linear_solver_ordering = ordering;
  }
  return solver;
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
    problem.points[i].inverse_depth = std::max(least_inverse_depth, built.state.inverseDepth(i));
  }
  return true;
}

}  // namespace

int adjustBundleByCeres(const Camera& camera, BundleProblem& problem, const BundleOptions& options) {
  const std::unique_ptr<CeresProblem> built = buildCeresProblem(camera, problem, options.huber);
  ceres::Solver::Summary summary;
  const ceres::Solver::Options solver = solverOptions(*built, options);
  ceres::Solve(solver, built->ceres.get(), &summary);
  if (!summary.IsSolutionUsable() || !readBack(*built, problem)) return -1;
  return static_cast<int>(summary.iterations.size()) - 1;
}

}  // namespace edgeslam::test
