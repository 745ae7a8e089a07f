#include "calibration/camera_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace edgeslam {
namespace {

using Matrix26d = Eigen::Matrix<double, 2, 6>;
using Matrix29d = Eigen::Matrix<double, 2, camera_parameters>;
using Matrix96d = Eigen::Matrix<double, camera_parameters, 6>;

constexpr double behind_px = 1e4;  // error of what does not lie before the camera
constexpr double nearest = 1e-6;   // least depth over distance

struct ViewEquations {
  Matrix6d pose = Matrix6d::Zero();
  Matrix96d mixed = Matrix96d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

struct Equations {
  double cost = 0;
  CameraMatrix camera = CameraMatrix::Zero();
  CameraVector gradient = CameraVector::Zero();
  std::vector<ViewEquations> views;
};

bool isBefore(const Camera& camera, const Eigen::Vector3d& point) {
  if (!point.allFinite()) return false;
  if (camera.model == CameraModel::kannala_brandt) return point.norm() > 1e-12;
  return point.z() > nearest * point.norm();
}

double huberCost(double norm, double huber) { return norm <= huber ? 0.5 * norm * norm : huber * (norm - 0.5 * huber); }

double costOf(const Camera& camera, const std::vector<FittedView>& views, double huber) {
  double cost = 0;
  for (const FittedView& view : views) {
    for (const MeasuredCorner& corner : view.corners) {
      const double norm = (corner.whitening * cornerError(camera, view.camera_T_board, corner)).norm();
      cost += huberCost(norm, huber);
    }
  }
  return cost;
}

Equations linearize(const Camera& camera, const std::vector<FittedView>& views, const FitOptions& options) {
  Equations equations;
  for (const FittedView& view : views) {
    ViewEquations& own = equations.views.emplace_back();
    const Eigen::Matrix3d rotation = view.camera_T_board.rotation.toRotationMatrix();
    for (const MeasuredCorner& corner : view.corners) {
      const Eigen::Vector3d place(corner.place_m.x(), corner.place_m.y(), 0);
      const Eigen::Vector3d point = view.camera_T_board * place;
      const Eigen::Vector2d error = corner.whitening * cornerError(camera, view.camera_T_board, corner);
      const double norm = error.norm();
      equations.cost += huberCost(norm, options.huber);
      if (!isBefore(camera, point)) continue;
      Eigen::Matrix<double, 2, 3> by_point;
      project(camera, point, &by_point);
      Eigen::Matrix<double, 3, 6> point_by_pose;
      point_by_pose << rotation, -rotation * skew(place);
      const Matrix26d by_pose = corner.whitening * by_point * point_by_pose;
      Matrix29d by_camera = corner.whitening * parameterJacobian(camera, point);
      for (int i = 0; i < camera_parameters; ++i) {
        if (!options.free[static_cast<std::size_t>(i)]) by_camera.col(i).setZero();
      }
      const double weight = norm <= options.huber ? 1 : options.huber / norm;
      own.pose.noalias() += weight * by_pose.transpose() * by_pose;
      own.mixed.noalias() += weight * by_camera.transpose() * by_pose;
      own.gradient.noalias() += weight * by_pose.transpose() * error;
      equations.camera.noalias() += weight * by_camera.transpose() * by_camera;
      equations.gradient.noalias() += weight * by_camera.transpose() * error;
    }
  }
  return equations;
}

Matrix6d damped(const Matrix6d& information, double damping) {
  Matrix6d m = information;
  m.diagonal() *= 1 + damping;
  m.diagonal().array() += 1e-12 * (1 + information.diagonal().maxCoeff());
  return m;
}

// Eliminates the poses. `reduced` keeps a 1 where a parameter is not free, so that it can be inverted.
void reduce(const Equations& equations, const FitOptions& options, double damping, CameraMatrix& reduced,
            CameraVector& gradient) {
  reduced = equations.camera;
  reduced.diagonal() *= 1 + damping;
  gradient = equations.gradient;
  for (const ViewEquations& view : equations.views) {
    const Eigen::LDLT<Matrix6d> factor(damped(view.pose, damping));
    reduced.noalias() -= view.mixed * factor.solve(view.mixed.transpose());
    gradient.noalias() -= view.mixed * factor.solve(view.gradient);
  }
  for (int i = 0; i < camera_parameters; ++i) {
    if (!options.free[static_cast<std::size_t>(i)]) reduced(i, i) = 1;
  }
}

// A step in units in which the diagonal is 1, as the parameters' sizes are far apart.
CameraVector solveScaled(const CameraMatrix& matrix, const CameraVector& right) {
  const CameraVector scale = matrix.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const CameraMatrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(right)));
}

}  // namespace

Eigen::Vector2d cornerError(const Camera& camera, const Pose& camera_T_board, const MeasuredCorner& corner) {
  const Eigen::Vector3d point = camera_T_board * Eigen::Vector3d(corner.place_m.x(), corner.place_m.y(), 0);
  if (!isBefore(camera, point)) return {behind_px, behind_px};
  const Eigen::Vector2d error = project(camera, point) - corner.pixel;
  return error.allFinite() && error.norm() < behind_px ? error : Eigen::Vector2d(behind_px, behind_px);
}

FitResult fitCamera(Camera& camera, std::vector<FittedView>& views, const FitOptions& options) {
  FitResult result;
  double damping = 1e-3;
  Equations equations = linearize(camera, views, options);
  for (int iteration = 0; iteration < options.iterations && !result.converged && damping < 1e10; ++iteration) {
    CameraMatrix reduced;
    CameraVector gradient;
    reduce(equations, options, damping, reduced, gradient);
    const CameraVector step = -solveScaled(reduced, gradient);
    Camera moved = changedCamera(camera, step);
    std::vector<FittedView> moved_views = views;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const ViewEquations& view = equations.views[i];
      const Vector6d change = damped(view.pose, damping).ldlt().solve(-view.gradient - view.mixed.transpose() * step);
      moved_views[i].camera_T_board = retract(views[i].camera_T_board, change);
    }
    const bool is_camera = step.allFinite() && moved.fx > 1 && moved.fy > 1;
    const double cost = is_camera ? costOf(moved, moved_views, options.huber) : equations.cost + 1;
    if (!(cost <= equations.cost)) {
      damping *= 8;
      continue;
    }
    result.converged = equations.cost - cost <= 1e-10 * equations.cost + 1e-14;
    damping = std::max(damping / 5, 1e-9);
    camera = moved;
    views = std::move(moved_views);
    equations = linearize(camera, views, options);
  }
  result.converged = result.converged || damping >= 1e10;  // nothing is better than where it is
  result.cost = equations.cost;
  CameraVector gradient;
  reduce(equations, options, 0, result.information, gradient);
  for (int i = 0; i < camera_parameters; ++i) {
    if (!options.free[static_cast<std::size_t>(i)]) result.information(i, i) = 0;
  }
  return result;
}

double rmsError(const Camera& camera, const std::vector<FittedView>& views) {
  double sum = 0;
  std::size_t count = 0;
  for (const FittedView& view : views) {
    for (const MeasuredCorner& corner : view.corners) {
      sum += cornerError(camera, view.camera_T_board, corner).squaredNorm();
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

CameraMatrix parameterCovariance(const FitResult& fit, const FitOptions& options, double variance_factor) {
  CameraMatrix information = fit.information;
  for (int i = 0; i < camera_parameters; ++i) {
    if (!options.free[static_cast<std::size_t>(i)]) information(i, i) = 1;
  }
  const CameraVector scale = information.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const CameraMatrix scaled = scale.asDiagonal() * information * scale.asDiagonal();
  CameraMatrix covariance = variance_factor * (scale.asDiagonal() * scaled.inverse() * scale.asDiagonal());
  for (int i = 0; i < camera_parameters; ++i) {
    if (options.free[static_cast<std::size_t>(i)]) continue;
    covariance.row(i).setZero();
    covariance.col(i).setZero();
  }
  return covariance;
}

Matrix29d parameterJacobian(const Camera& camera, const Eigen::Vector3d& point) {
  Camera plain = camera;
  plain.fx = plain.fy = 1;
  plain.cx = plain.cy = 0;
  const Eigen::Vector2d distorted = project(plain, point);
  Matrix29d jacobian = Matrix29d::Zero();
  jacobian(0, 0) = distorted.x();
  jacobian(1, 1) = distorted.y();
  jacobian(0, 2) = jacobian(1, 3) = 1;
  Eigen::Matrix<double, 2, 5> by_distortion = Eigen::Matrix<double, 2, 5>::Zero();
  if (camera.model == CameraModel::kannala_brandt) {
    const double radius = std::hypot(point.x(), point.y()), theta = std::atan2(radius, point.z());
    if (radius > 1e-12) {
      const Eigen::Vector2d direction(point.x() / radius, point.y() / radius);
      for (int i = 0; i < 4; ++i) by_distortion.col(i) = direction * std::pow(theta, 2 * i + 3);
    }
  } else {
    const double x = point.x() / point.z(), y = point.y() / point.z(), r2 = x * x + y * y;
    const Eigen::Vector2d u(x, y);
    by_distortion << u * r2, u * r2 * r2, Eigen::Vector2d(2 * x * y, r2 + 2 * y * y),
        Eigen::Vector2d(r2 + 2 * x * x, 2 * x * y), u * r2 * r2 * r2;
  }
  jacobian.row(0).tail<5>() = camera.fx * by_distortion.row(0);
  jacobian.row(1).tail<5>() = camera.fy * by_distortion.row(1);
  return jacobian;
}

Camera changedCamera(const Camera& camera, const CameraVector& change) {
  Camera changed = camera;
  changed.fx += change(0);
  changed.fy += change(1);
  changed.cx += change(2);
  changed.cy += change(3);
  for (int i = 0; i < 5; ++i) changed.distortion[static_cast<std::size_t>(i)] += change(4 + i);
  return changed;
}

}  // namespace edgeslam
