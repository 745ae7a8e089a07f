#include "wheels/wheel_motion.h"

#include <algorithm>
#include <cmath>

#include "geometry/squared.h"
#include "geometry/uncertainty.h"

namespace edgeslam {
namespace {

// Standard deviations of a small robot's odometry on a hard floor. What slips grows with the root of the way and of the
// turn; the size of the wheels, and where the camera is on the body, err in proportion.
constexpr double way_per_root_metre = 0.03;  // [m/sqrt(m)]
constexpr double way_share = 0.02;           // of the way
constexpr double way_per_turn = 0.02;        // [m/rad]
constexpr double least_way = 1e-3;           // [m]
constexpr double turn_per_root_radian = 0.03;
constexpr double turn_per_root_metre = 0.01;  // [rad/sqrt(m)]
constexpr double least_turn = 2e-3;           // [rad]
// Out of the plane: of ramps and thresholds, and on a plane floor, where a body rocks.
constexpr double tilt_per_root_metre = 0.05, planar_tilt_per_root_metre = 0.01;  // [rad/sqrt(m)]
constexpr double least_tilt = 0.01, planar_least_tilt = 3e-3;                    // [rad]
constexpr double rise_share = 0.05, planar_rise_share = 0.005;                   // of the way
// As long as the wheels told nothing, the body may have changed its speed by so much.
constexpr double unheard_acceleration = 1;       // [m/s^2]
constexpr double unheard_turn_acceleration = 2;  // [rad/s^2]

}  // namespace

std::optional<WheelMotion> wheelMotion(const WheelOptions& options, const OdometryPlace& first,
                                       const OdometryPlace& second) {
  if (first.piece < 0 || first.piece != second.piece) return std::nullopt;
  const Pose body_moved = first.local_T_body.inverse() * second.local_T_body;
  const double way = std::abs(second.way_m - first.way_m), turn = std::abs(second.turn_rad - first.turn_rad);
  const double straight = body_moved.translation.norm();
  const bool planar = options.planar;

  const double unheard = 0.25 * (squared(squared(first.beyond_s)) + squared(squared(second.beyond_s)));
  const double turn_variance = squared(turn_per_root_radian) * turn + squared(turn_per_root_metre) * way +
                               squared(least_turn) + squared(unheard_turn_acceleration) * unheard;
  const double tilt_variance = squared(planar ? planar_tilt_per_root_metre : tilt_per_root_metre) * way +
                               squared(turn_per_root_radian) * turn + squared(planar ? planar_least_tilt : least_tilt);
  const double way_variance = squared(way_per_root_metre) * way + squared(way_share * straight) +
                              squared(way_per_turn * turn) + 0.25 * turn_variance * squared(straight) +
                              squared(least_way) + squared(unheard_acceleration) * unheard;
  const double rise_variance = squared((planar ? planar_rise_share : rise_share) * way);
  // The normal of the odometry's plane, as the body lies at the end.
  const Eigen::Vector3d normal = second.local_T_body.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d across = normal * normal.transpose();
  Matrix6d of_body = Matrix6d::Zero();
  of_body.topLeftCorner<3, 3>() = way_variance * Eigen::Matrix3d::Identity() + rise_variance * across;
  of_body.bottomRightCorner<3, 3>() =
      std::max(tilt_variance, turn_variance) * (Eigen::Matrix3d::Identity() - across) + turn_variance * across;
  return WheelMotion{options.body_T_camera.inverse() * body_moved * options.body_T_camera,
                     carriedCovariance(of_body, options.body_T_camera)};
}

}  // namespace edgeslam
