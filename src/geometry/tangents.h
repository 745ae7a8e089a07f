// Directions that are square to another one.
#pragma once

#include <Eigen/Geometry>

namespace edgeslam {

// Two unit directions square to a unit direction and to each other.
inline Eigen::Matrix<double, 3, 2> tangentsOf(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = direction.unitOrthogonal();
  tangents.col(1) = direction.cross(tangents.col(0));
  return tangents;
}

}  // namespace edgeslam
