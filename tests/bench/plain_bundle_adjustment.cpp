#include "bench/plain_bundle_adjustment.h"

#include <ceres/ceres.h>

#include <array>
#include <memory>
#include <vector>

#include "adjustment/bundle_linearization.h"

namespace edgeslam {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Of a camera its centre and the rotation vector from its first orientation, which stays small.
class PlainState final : public ceres::EvaluationCallback {
 public:
  explicit PlainState(const BundleProblem& problem) {
    for (const BundleCamera& c : problem.cameras) {
      const Eigen::Vector3d& t = c.world_T_camera.translation;
      cameras.push_back({t.x(), t.y(), t.z(), 0, 0, 0});
      starts.push_back(c.world_T_camera.rotation);
      frames.push_back(cameraFrame(c.world_T_camera));
    }
    for (const BundlePoint& p : problem.points)
      points.push_back(problem.cameras[at(p.host)].world_T_camera * (p.host_bearing / p.inverse_depth));
  }

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool new_evaluation_point) override {
    if (!new_evaluation_point) return;
    for (std::size_t i = 0; i < cameras.size(); ++i) frames[i] = cameraFrame(pose(i));
  }

  Pose pose(std::size_t i) const {
    const Eigen::Map<const Vector6d> p(cameras[i].data());
    return {(rotationExp(p.tail<3>()) * starts[i]).normalized(), p.head<3>()};
  }

  std::vector<std::array<double, 6>> cameras;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Quaterniond> starts;
  std::vector<CameraFrame> frames;
};

class PlainCost final : public ceres::SizedCostFunction<2, 6, 3> {
 public:
  PlainCost(const Camera& camera, const Measurement& measurement, int view, const PlainState& state)
      : camera_(camera), measured_{measurement.pixel, whitening(measurement)}, view_(at(view)), state_(state) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> point(parameters[1]);
    const Eigen::Vector3d seen = point - state_.frames[view_].centre;
    Eigen::Vector2d residual(behind_norm, 0);
    Matrix23d by_sight;
    if (!sightResidual(camera_, measured_, state_.frames[view_], seen, residual, jacobians ? &by_sight : nullptr))
      by_sight.setZero();
    Eigen::Map<Eigen::Vector2d>(residuals, 2) = residual;
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> by_camera(jacobians[0]);
      by_camera << -by_sight, by_sight * skew(seen);  // by the turn, where the rotation vector is small
    }
    if (jacobians && jacobians[1]) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> by_point(jacobians[1]);
      by_point = by_sight;
    }
    return true;
  }

 private:
  const Camera& camera_;
  WhitenedPixel measured_;
  std::size_t view_;
  const PlainState& state_;
};

void readBack(const PlainState& state, BundleProblem& problem) {
  for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
    if (!problem.cameras[i].fixed) problem.cameras[i].world_T_camera = state.pose(i);
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    BundlePoint& p = problem.points[i];
    p.inverse_depth = 1 / (problem.cameras[at(p.host)].world_T_camera.inverse() * state.points[i]).norm();
  }
}

}  // namespace

int adjustBundlePlainly(const Camera& camera, BundleProblem& problem, const BundleOptions& options, bool sparse) {
  PlainState state(problem);
  ceres::HuberLoss loss(options.huber);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  ownership.evaluation_callback = &state;
  ceres::Problem plain(ownership);
  const auto add = [&](int view, int point, const Measurement& measurement) {
    plain.AddResidualBlock(new PlainCost(camera, measurement, view, state), &loss, state.cameras[at(view)].data(),
                           state.points[at(point)].data());
  };
  std::vector<char> host_seen(problem.points.size(), 0);
  for (const BundleObservation& o : problem.observations) {
    const BundlePoint& p = problem.points[at(o.point)];
    if (!host_seen[at(o.point)]) {
      Measurement host = o.measurement;
      host.pixel = project(camera, p.host_bearing);
      add(p.host, o.point, host);
    }
    host_seen[at(o.point)] = 1;
    add(o.camera, o.point, o.measurement);
  }
  ceres::Solver::Options solver;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    if (host_seen[i]) ordering->AddElementToGroup(state.points[i].data(), 0);
  }
  for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
    if (!plain.HasParameterBlock(state.cameras[i].data())) continue;
    ordering->AddElementToGroup(state.cameras[i].data(), 1);
    if (problem.cameras[i].fixed) plain.SetParameterBlockConstant(state.cameras[i].data());
  }
  solver.max_num_iterations = options.iterations;
  solver.num_threads = 1;
  solver.function_tolerance = 1e-6;
  solver.logging_type = ceres::SILENT;
  solver.linear_solver_type = sparse ? ceres::SPARSE_SCHUR : ceres::DENSE_SCHUR;
  solver.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &plain, &summary);
  if (!summary.IsSolutionUsable()) return -1;
  readBack(state, problem);
  return static_cast<int>(summary.iterations.size()) - 1;
}

}  // namespace edgeslam
