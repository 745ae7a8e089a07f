// Straight lines of space, as landmarks: four unknowns each, two that shift a line and two that turn it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>

namespace edgeslam {

// All point + s * direction, in one frame [map units].
struct SpaceLine {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // near the part that is seen, else anywhere on the line
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit
};

using LineBasis = Eigen::Matrix<double, 3, 2>;

// Two orthonormal vectors across a unit direction, always the same ones for the same direction. They jump where another
// of its components becomes the smallest.
inline LineBasis lineBasis(const Eigen::Vector3d& direction) {
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  LineBasis basis;
  basis.col(0) = Eigen::Vector3d::Unit(smallest).cross(direction).normalized();
  basis.col(1) = direction.cross(basis.col(0));
  return basis;
}

// Shifted across its direction by the change's first two numbers [map units], turned about its point by the others
// [rad, to first order], along the vectors of its lineBasis(). The point is not brought to the foot of a perpendicular.
inline SpaceLine movedLine(const SpaceLine& line, const Eigen::Vector4d& change) {
  const LineBasis basis = lineBasis(line.direction);
  return {line.point + basis * change.head<2>(), (line.direction + basis * change.tail<2>()).normalized()};
}

// How far along a ray (unit) its point nearest to the line is [map units]: negative where that is behind the origin,
// NaN where both are parallel to within 1e-6 rad, which no comparison lets pass.
inline double distanceAlongRay(const SpaceLine& line, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  constexpr double least_sine = 1e-6;
  const Eigen::Vector3d across = ray.cross(line.direction);
  const double squared_sine = across.squaredNorm();
  if (!(squared_sine > least_sine * least_sine)) return std::numeric_limits<double>::quiet_NaN();
  return (line.point - origin).cross(line.direction).dot(across) / squared_sine;
}

// The line's point nearest to x.
inline Eigen::Vector3d closestPoint(const SpaceLine& line, const Eigen::Vector3d& x) {
  return line.point + (x - line.point).dot(line.direction) * line.direction;
}

}  // namespace edgeslam
