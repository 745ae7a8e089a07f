#include "adjustment/pose_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "adjustment/reprojection.h"

namespace edgeslam {
namespace {

struct PreparedObservation {
  Eigen::Vector3d point;  // world frame
  WhitenedPixel measured;
  double row_time_s = 0;  // when its row is read, after the middle one
};

// Whitening of a measurement whose point's depth is uncertain too: Cholesky of diag(sigma_normal^2, sigma_tangent^2)
// plus the depth's share, in the edge's own axes (across, along), so that the first entry stays the one across the
// edge.
Eigen::Matrix2d whiteningWithDepth(const PoseObservation& observation) {
  const Measurement& m = observation.measurement;
  if (!(observation.depth_sigma_px > 0)) return whitening(m);
  Eigen::Matrix2d edge_axes;
  edge_axes << m.normal.x(), m.normal.y(), -m.normal.y(), m.normal.x();
  const Eigen::Vector2d shift = observation.depth_sigma_px * (edge_axes * observation.depth_direction);
  const double across = std::sqrt(m.sigma_normal * m.sigma_normal + shift.x() * shift.x());
  const double mixed = shift.x() * shift.y() / across;
  const double along = std::sqrt(m.sigma_tangent * m.sigma_tangent + shift.y() * shift.y() - mixed * mixed);
  Eigen::Matrix2d inverse_root;
  inverse_root << 1 / across, 0, -mixed / (across * along), 1 / along;
  return inverse_root * edge_axes;
}

using PreparedObservations = std::pmr::vector<PreparedObservation>;

PreparedObservations prepare(const Camera& camera, const PoseObservations& observations,
                             std::pmr::memory_resource* memory) {
  PreparedObservations prepared(memory);
  prepared.reserve(observations.size());
  for (const PoseObservation& o : observations) {
    prepared.push_back(
        {o.point, {o.measurement.pixel, whiteningWithDepth(o)}, rowTime(camera, o.measurement.pixel.y())});
  }
  return prepared;
}

// The residuals of a camera whose rows are read at once.
class GlobalShutter {
 public:
  GlobalShutter(const Camera& camera, const Pose& world_T_camera)
      : camera_(camera), frame_(cameraFrame(world_T_camera)) {}

  bool residual(const PreparedObservation& o, Eigen::Vector2d& residual, Matrix26d& jacobian) const {
    return poseResidual(camera_, o.measured, frame_, o.point, residual, &jacobian);
  }

 private:
  const Camera& camera_;
  CameraFrame frame_;
};

// The residuals of a camera that moves while its rows are read.
class RollingShutter {
 public:
  RollingShutter(const Camera& camera, const RowMotion& motion, const Pose& world_T_camera)
      : camera_(camera),
        frame_(cameraFrame(world_T_camera)),
        twist_(twistOf(motion, world_T_camera, &twist_by_pose_)),
        is_tied_(motion.seconds > 0) {}

  bool residual(const PreparedObservation& o, Eigen::Vector2d& residual, Matrix26d& jacobian) const {
    Matrix26d by_twist;
    if (!rowResidual(camera_, o.measured, frame_, twist_, o.row_time_s, o.point, residual, jacobian,
                     is_tied_ ? &by_twist : nullptr)) {
      return false;
    }
    if (is_tied_) jacobian.noalias() += by_twist * twist_by_pose_;
    return true;
  }

 private:
  const Camera& camera_;
  CameraFrame frame_;
  Matrix6d twist_by_pose_;  // before the twist, which is made together with it
  Twist twist_;
  bool is_tied_;
};

// A point behind the camera costs what an error of this whitened norm does; so does anything worse, without pulling.
constexpr double norm_behind_camera = 1e4;

// Weights frozen at the pose.
template <typename Shutter>
PoseEquations linearize(const Shutter& shutter, const PreparedObservations& observations, double huber) {
  const double behind_cost = huberLoss(norm_behind_camera * norm_behind_camera, huber);
  PoseEquations equations;
  for (const PreparedObservation& o : observations) {
    Eigen::Vector2d residual;
    Matrix26d jacobian;
    if (!shutter.residual(o, residual, jacobian)) {
      equations.cost += behind_cost;
      continue;
    }
    const double squared_norm = residual.squaredNorm();
    if (!(squared_norm < norm_behind_camera * norm_behind_camera)) {
      equations.cost += behind_cost;
      continue;
    }
    equations.cost += huberLoss(squared_norm, huber);
    const double weight = huberWeight(std::sqrt(squared_norm), huber);
    const Matrix26d weighted = weight * jacobian;
    equations.information.noalias() += weighted.transpose() * jacobian;
    equations.gradient.noalias() += weighted.transpose() * residual;
  }
  return equations;
}

// Solves (information + damping * diagonal) x = -gradient in units where the diagonal is 1. False: singular to working
// precision.
bool solveDamped(const PoseEquations& equations, double damping, Vector6d& step) {
  const Vector6d scale = equations.information.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0) || !scale.allFinite()) return false;
  Matrix6d scaled = scale.cwiseInverse().asDiagonal() * equations.information * scale.cwiseInverse().asDiagonal();
  scaled.diagonal().array() += damping;
  const Eigen::LDLT<Matrix6d> factor(scaled);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-13)) return false;
  step = -factor.solve(equations.gradient.cwiseQuotient(scale)).cwiseQuotient(scale);
  return step.allFinite();
}

void addPrior(const PosePrior& prior, const Pose& world_T_camera, PoseEquations& equations) {
  const PoseEquations known = priorEquations(prior, world_T_camera);
  equations.cost += known.cost;
  equations.information += known.information;
  equations.gradient += known.gradient;
}

// Levenberg's minimisation with the weights renewed at every step. While far from the solution Huber's threshold is
// wide, so that a prediction several pixels off does not make every observation an outlier.
// `shutterAt`: gives the residuals of a camera with a pose.
template <typename ShutterAt>
bool minimize(const ShutterAt& shutterAt, const PreparedObservations& observations, const PosePrior& prior,
              const PoseOptions& options, Pose& pose) {
  constexpr int wide_iterations = 3;
  constexpr double wide_factor = 5;
  constexpr double least_pose_damping = 1e-6;  // holds the directions that nothing measures, without moving the minimum
  constexpr double most_pose_damping = 1e2;

  double huber = options.huber * wide_factor;
  double damping = least_pose_damping;
  const auto equationsAt = [&](const Pose& at) {
    PoseEquations equations = linearize(shutterAt(at), observations, huber);
    addPrior(prior, at, equations);
    return equations;
  };
  PoseEquations equations = equationsAt(pose);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    if (iteration == wide_iterations) {
      huber = options.huber;
      equations = equationsAt(pose);
    }
    bool accepted = false, small = false;
    while (!accepted && damping <= most_pose_damping) {
      Vector6d step;
      if (!solveDamped(equations, damping, step)) return false;
      // In units of the pose's own standard deviation, so free of scale.
      small = step.dot(equations.information * step) < 1e-8;
      const Pose candidate = retract(pose, step);
      const PoseEquations at_candidate = equationsAt(candidate);
      accepted = at_candidate.cost <= equations.cost;
      if (accepted) {
        pose = candidate;
        equations = at_candidate;
        damping = std::max(least_pose_damping, 0.1 * damping);
      } else {
        if (small) break;
        damping = damping * 30;
      }
    }
    if (small || !accepted) {
      if (iteration >= wide_iterations) break;
      iteration = wide_iterations - 1;  // done with the wide threshold: on to the narrow one
      damping = least_pose_damping;
    }
  }
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite();
}

// At the minimum of both the observations pull against the prior.
Vector6d withoutPrior(const Matrix6d& information, const PoseEquations& prior) {
  PoseEquations observed;
  observed.information = information - prior.information;
  observed.gradient = -prior.gradient;
  Vector6d step;
  if (!solveDamped(observed, 0, step)) step.setConstant(std::numeric_limits<double>::infinity());
  return step;
}

// Inliers, rms and covariance at the final pose. `prior`: there.
template <typename Shutter>
bool judge(const Shutter& shutter, const PreparedObservations& observations, const PoseEquations& prior,
           const PoseOptions& options, PoseResult& result) {
  Matrix6d information = prior.information;
  Eigen::Array2d weighted_squares = Eigen::Array2d::Zero();  // across the edge, along it
  double squares = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Eigen::Vector2d residual;
    Matrix26d jacobian;
    if (!shutter.residual(observations[i], residual, jacobian)) continue;
    result.errors_across[i] = residual.x();
    const double norm = residual.norm();
    if (!(norm <= options.outlier)) continue;
    result.inliers[i] = 1;
    ++result.inlier_count;
    squares += norm * norm;
    const double weight = huberWeight(norm, options.huber);
    information.noalias() += (weight * jacobian.transpose()) * jacobian;
    weighted_squares += weight * residual.array().square();
  }
  if (result.inlier_count < std::max(options.fewest, 4)) return false;
  result.rms = std::sqrt(squares / result.inlier_count);
  if (!prior.information.isZero(0)) result.without_prior = withoutPrior(information, prior);
  const Vector6d scale = information.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0) || !scale.allFinite()) return false;
  const Vector6d unscale = scale.cwiseInverse();
  const Eigen::LDLT<Matrix6d> factor(Matrix6d(unscale.asDiagonal() * information * unscale.asDiagonal()));
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-13)) return false;
  const Matrix6d inverse = factor.solve(Matrix6d::Identity());
  // The two whitened entries are judged apart, since that along an edge is near 0 whatever the noise. Each bears half
  // of the pose's six unknowns.
  const double variance_factor = (weighted_squares / (result.inlier_count - 3)).maxCoeff();
  result.covariance = std::max(1.0, variance_factor) *
                      Matrix6d(unscale.asDiagonal() * (0.5 * (inverse + inverse.transpose())) * unscale.asDiagonal());
  return result.covariance.allFinite();
}

}  // namespace

PoseObservation observeWithDepth(const Camera& camera, const Pose& camera_T_host, const HostedPoint& point,
                                 const Eigen::Vector3d& world_position, const Measurement& measurement) {
  PoseObservation observation;
  observation.point = world_position;
  observation.measurement = measurement;
  const Eigen::Vector3d scaled =
      camera_T_host.rotation * point.host_bearing + point.inverse_depth * camera_T_host.translation;
  if (!(scaled.z() > 1e-3)) return observation;
  Eigen::Matrix<double, 2, 3> jacobian;
  project(camera, scaled, &jacobian);
  const Eigen::Vector2d motion = jacobian * camera_T_host.translation;  // d pixel / d inverse depth
  const double length = motion.norm();
  if (!(length > 1e-9)) return observation;
  observation.depth_sigma_px = length * point.inverse_depth_sigma;
  observation.depth_direction = motion / length;
  return observation;
}

PosePrior moved(const Similarity& new_S_old, const PosePrior& prior) {
  PosePrior result{moved(new_S_old, prior.world_T_camera), prior.information};
  const double old_units_a_new_one = 1 / new_S_old.scale;
  result.information.topRows<3>() *= old_units_a_new_one;
  result.information.leftCols<3>() *= old_units_a_new_one;
  return result;
}

PoseResult adjustPose(const Camera& camera, const Pose& initial_world_T_camera, const PoseObservations& observations,
                      const PoseOptions& options, std::pmr::memory_resource* memory, const RowMotion& motion,
                      const PosePrior& prior) {
  PoseResult result(memory);
  result.world_T_camera = initial_world_T_camera;
  result.inliers.assign(observations.size(), 0);
  result.errors_across.assign(observations.size(), std::numeric_limits<double>::infinity());
  if (observations.empty() || static_cast<int>(observations.size()) < options.fewest) return result;
  const PreparedObservations prepared = prepare(camera, observations, memory);
  const auto adjust = [&](const auto& shutterAt) {
    Pose pose = initial_world_T_camera;
    result.converged = minimize(shutterAt, prepared, prior, options, pose) &&
                       judge(shutterAt(pose), prepared, priorEquations(prior, pose), options, result);
    if (result.converged) result.world_T_camera = pose;
  };
  if (camera.readout_s == 0) {
    adjust([&](const Pose& pose) { return GlobalShutter(camera, pose); });
  } else {
    adjust([&](const Pose& pose) { return RollingShutter(camera, motion, pose); });
  }
  result.twist = twistOf(motion, result.world_T_camera);
  return result;
}

PoseEquations poseEquations(const Camera& camera, const MovingCamera& moving, const PoseObservations& observations,
                            const PoseOptions& options) {
  const PreparedObservations prepared = prepare(camera, observations, std::pmr::get_default_resource());
  RowMotion motion;
  motion.before = moving.twist;
  if (camera.readout_s == 0) return linearize(GlobalShutter(camera, moving.world_T_camera), prepared, options.huber);
  return linearize(RollingShutter(camera, motion, moving.world_T_camera), prepared, options.huber);
}

PoseEquations priorEquations(const PosePrior& prior, const Pose& world_T_camera) {
  PoseEquations equations;
  if (prior.information.isZero(0)) return equations;
  const Eigen::Quaterniond prior_R_camera = prior.world_T_camera.rotation.conjugate() * world_T_camera.rotation;
  Vector6d error;
  error.head<3>() =
      prior.world_T_camera.rotation.conjugate() * (world_T_camera.translation - prior.world_T_camera.translation);
  error.tail<3>() = rotationLog(prior_R_camera);
  Matrix6d jacobian = Matrix6d::Zero();
  jacobian.topLeftCorner<3, 3>() = prior_R_camera.toRotationMatrix();
  jacobian.bottomRightCorner<3, 3>() = rightJacobian(error.tail<3>()).inverse();
  const Matrix6d weighted = prior.information * jacobian;
  equations.cost = error.dot(prior.information * error);
  equations.information.noalias() = jacobian.transpose() * weighted;
  equations.gradient.noalias() = weighted.transpose() * error;
  return equations;
}

Matrix6d poseInformation(const Camera& camera, const Pose& world_T_camera, const PoseObservations& observations) {
  const CameraFrame frame = cameraFrame(world_T_camera);
  Matrix6d information = Matrix6d::Zero();
  for (const PoseObservation& o : observations) {
    Eigen::Vector2d residual;
    Matrix26d jacobian;
    const WhitenedPixel measured{o.measurement.pixel, whiteningWithDepth(o)};
    if (poseResidual(camera, measured, frame, o.point, residual, &jacobian)) {
      information.noalias() += jacobian.transpose() * jacobian;
    }
  }
  return information;
}

}  // namespace edgeslam
