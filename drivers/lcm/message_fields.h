// Vectors, rotations and covariances as the fields of messages.
#pragma once

#include <algorithm>

#include "geometry/pose.h"

namespace edgeslam {

inline void put(const Eigen::Vector3d& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }

// w, x, y, z, with w not below 0.
inline void put(const Eigen::Quaterniond& from, double (&to)[4]) {
  const double sign = from.w() < 0 ? -1 : 1;
  to[0] = sign * from.w();
  to[1] = sign * from.x();
  to[2] = sign * from.y();
  to[3] = sign * from.z();
}

inline void put(const Matrix6d& from, double (&to)[6][6]) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) to[row][column] = from(row, column);
  }
}

}  // namespace edgeslam
