// What is measured of an edge point in an image: its pixel, known well across the edge and hardly along it. The
// information matrix is n n^T / sigma_normal^2 + t t^T / sigma_tangent^2 (design, section 5).
#pragma once

#include <Eigen/Core>

namespace edgeslam {

inline constexpr float unknown_along = 1000;  // standard deviation along an edge that tells nothing [px]

struct Measurement {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();    // distorted image coordinates [px]
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // unit, across the edge, from dark to bright
  double sigma_normal = 0.5;                          // standard deviation across the edge [px]
  double sigma_tangent = unknown_along;               // and along it [px]
};

// W (2x2) with W^T W = information matrix: a pixel error e becomes W e, whose two entries (across, along) have
// variance 1.
inline Eigen::Matrix2d whitening(const Measurement& m) {
  Eigen::Matrix2d w;
  w << m.normal.x() / m.sigma_normal, m.normal.y() / m.sigma_normal, -m.normal.y() / m.sigma_tangent,
      m.normal.x() / m.sigma_tangent;
  return w;
}

}  // namespace edgeslam
