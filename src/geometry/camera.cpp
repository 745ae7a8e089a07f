#include "geometry/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "geometry/distortion_reach.h"

namespace edgeslam {
namespace {

// Distorted normalized coordinates of undistorted ones, and their 2x2 derivative.
Eigen::Vector2d distortRadialTangential(const Camera& camera, const Eigen::Vector2d& u, Eigen::Matrix2d* derivative) {
  const std::array<double, 5>& k = camera.distortion;
  const double x = u.x(), y = u.y(), r2 = x * x + y * y;
  const double k1 = k[0], k2 = k[1], p1 = k[2], p2 = k[3], k3 = k[4];
  double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  double radial_r2 = k1 + r2 * (2 * k2 + 3 * k3 * r2);  // d radial / d r2
  if (r2 > camera.distortion_reach * camera.distortion_reach) {
    const DistortionTangent tangent = distortionTangent(camera);
    const double r = std::sqrt(r2);
    radial = tangent.slope + tangent.offset / r;
    radial_r2 = -0.5 * tangent.offset / (r2 * r);
  }
  if (derivative) {
    (*derivative) << radial + 2 * x * x * radial_r2 + 2 * p1 * y + 6 * p2 * x,
        2 * x * y * radial_r2 + 2 * p1 * x + 2 * p2 * y, 2 * x * y * radial_r2 + 2 * p1 * x + 2 * p2 * y,
        radial + 2 * y * y * radial_r2 + 6 * p1 * y + 2 * p2 * x;
  }
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

// Distorted angle of the angle theta [rad] from the optical axis, and its derivative.
double distortAngle(const Camera& camera, double theta, double* derivative) {
  if (theta > camera.distortion_reach) {
    const DistortionTangent tangent = distortionTangent(camera);
    if (derivative) *derivative = tangent.slope;
    return tangent.offset + tangent.slope * theta;
  }
  const std::array<double, 5>& k = camera.distortion;
  const double t2 = theta * theta;
  if (derivative) *derivative = 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
  return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

Eigen::Vector2d projectKannalaBrandt(const Camera& camera, const Eigen::Vector3d& p,
                                     Eigen::Matrix<double, 2, 3>* jacobian) {
  const double radius = std::hypot(p.x(), p.y());
  const double squared = radius * radius + p.z() * p.z();
  double angle_derivative = 1;
  const double distorted = distortAngle(camera, std::atan2(radius, p.z()), &angle_derivative);
  if (radius < 1e-9 * std::abs(p.z())) {
    if (jacobian) (*jacobian) << camera.fx / p.z(), 0, 0, 0, camera.fy / p.z(), 0;
    return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
  }
  const Eigen::Vector2d direction(p.x() / radius, p.y() / radius);
  if (jacobian) {
    const Eigen::RowVector3d angle_by_point(angle_derivative * p.z() * direction.x() / squared,
                                            angle_derivative * p.z() * direction.y() / squared,
                                            -angle_derivative * radius / squared);
    const double a = distorted / radius;
    Eigen::Matrix<double, 2, 3> direction_part;  // distorted * d direction / d point
    direction_part << a * direction.y() * direction.y(), -a * direction.x() * direction.y(), 0,
        -a * direction.x() * direction.y(), a * direction.x() * direction.x(), 0;
    *jacobian = direction * angle_by_point + direction_part;
    jacobian->row(0) *= camera.fx;
    jacobian->row(1) *= camera.fy;
  }
  return {camera.fx * distorted * direction.x() + camera.cx, camera.fy * distorted * direction.y() + camera.cy};
}

Eigen::Vector2d undistortRadialTangential(const Camera& camera, const Eigen::Vector2d& distorted) {
  Eigen::Vector2d u = distorted;
  for (int i = 0; i < 20; ++i) {
    Eigen::Matrix2d derivative;
    const Eigen::Vector2d error = distortRadialTangential(camera, u, &derivative) - distorted;
    const Eigen::Vector2d step = derivative.inverse() * error;
    if (!step.allFinite()) break;
    u -= step;
    if (step.squaredNorm() < 1e-24) break;
  }
  return u;
}

double undistortAngle(const Camera& camera, double distorted) {
  double theta = distorted;
  for (int i = 0; i < 20; ++i) {
    double derivative = 1;
    const double step = (distortAngle(camera, theta, &derivative) - distorted) / derivative;
    if (!std::isfinite(step)) break;
    theta -= step;
    if (std::abs(step) < 1e-12) break;
  }
  return theta;
}

}  // namespace

Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& point, Eigen::Matrix<double, 2, 3>* jacobian) {
  if (camera.model == CameraModel::kannala_brandt) return projectKannalaBrandt(camera, point, jacobian);
  const double inverse_z = 1.0 / point.z();
  const Eigen::Vector2d u(point.x() * inverse_z, point.y() * inverse_z);
  Eigen::Matrix2d derivative;
  const Eigen::Vector2d d = distortRadialTangential(camera, u, jacobian ? &derivative : nullptr);
  if (jacobian) {
    Eigen::Matrix<double, 2, 3> normalized;
    normalized << inverse_z, 0, -u.x() * inverse_z, 0, inverse_z, -u.y() * inverse_z;
    *jacobian = derivative * normalized;
    jacobian->row(0) *= camera.fx;
    jacobian->row(1) *= camera.fy;
  }
  return {camera.fx * d.x() + camera.cx, camera.fy * d.y() + camera.cy};
}

Eigen::Vector3d bearing(const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d distorted((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  if (camera.model == CameraModel::kannala_brandt) {
    const double distorted_angle = distorted.norm();
    if (distorted_angle < 1e-12) return Eigen::Vector3d::UnitZ();
    const double theta = undistortAngle(camera, distorted_angle);
    const Eigen::Vector2d direction = distorted / distorted_angle;
    return {std::sin(theta) * direction.x(), std::sin(theta) * direction.y(), std::cos(theta)};
  }
  const Eigen::Vector2d u = undistortRadialTangential(camera, distorted);
  return Eigen::Vector3d(u.x(), u.y(), 1).normalized();
}

}  // namespace edgeslam
