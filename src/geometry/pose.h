// Rigid transformations. Conventions of the whole project: `a_T_b` takes coordinates in b to coordinates in a; a small
// update (6) is [translation; rotation vector [rad]] and is applied on the right:
//   retract(a_T_b, d).translation = a_T_b.translation + a_T_b.rotation * d.head<3>()
//   retract(a_T_b, d).rotation    = a_T_b.rotation * exp(d.tail<3>())
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace edgeslam {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Pose inverse() const {
    const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
    return {inverse_rotation, -(inverse_rotation * translation)};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  Pose operator*(const Pose& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
};

inline bool isFinite(const Pose& pose) { return pose.translation.allFinite() && pose.rotation.coeffs().allFinite(); }

inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// The square of the angle [rad] up to which a series of five terms gives sines and cosines to the last bits. It needs
// no call of a library, whose last bits hang on the processor.
constexpr double most_squared_for_series = 0.02;

// Unit quaternion of a rotation vector [rad].
inline Eigen::Quaterniond rotationExp(const Eigen::Vector3d& rotation_vector) {
  const double s = rotation_vector.squaredNorm();
  if (!(s < most_squared_for_series)) {
    const double angle = std::sqrt(s);
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
  }
  // Of half the angle: its cosine, and its sine over the angle.
  const double cosine = 1 - 1.0 / 8 * s * (1 - 1.0 / 48 * s * (1 - 1.0 / 120 * s * (1 - 1.0 / 224 * s)));
  const double sine = 0.5 - 1.0 / 48 * s * (1 - 1.0 / 80 * s * (1 - 1.0 / 168 * s * (1 - 1.0 / 288 * s)));
  return {cosine, sine * rotation_vector.x(), sine * rotation_vector.y(), sine * rotation_vector.z()};
}

// Rotation vector [rad], of length at most pi, of a unit quaternion.
Eigen::Vector3d rotationLog(const Eigen::Quaterniond& rotation);

inline Pose retract(const Pose& pose, const Vector6d& update) {
  return {(pose.rotation * rotationExp(update.tail<3>())).normalized(),
          pose.translation + pose.rotation * update.head<3>()};
}

// Angle [rad] between two orientations.
inline double rotationAngle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) { return a.angularDistance(b); }

}  // namespace edgeslam
