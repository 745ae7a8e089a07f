// Horn's method (1987), with the rotation and the least-squares scale as in Umeyama (1991), which Eigen keeps.
#include "geometry/similarity.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace edgeslam {
namespace {

Eigen::Matrix3Xd columns(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd matrix(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return matrix;
}

// True where the points are one point but for rounding: then neither a rotation nor a scale follows from them.
bool coincide(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d mean = points.rowwise().mean();
  const double spread = (points.colwise() - mean).cwiseAbs().maxCoeff();
  return spread <= 1e-14 * points.cwiseAbs().maxCoeff();
}

}  // namespace

Similarity alignHorn(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                     bool with_scale) {
  if (from.empty() || from.size() != to.size()) {
    throw std::invalid_argument("alignHorn needs two point sets of the same size, of at least one point");
  }
  const Eigen::Matrix3Xd source = columns(from), target = columns(to);
  if (!source.allFinite() || !target.allFinite()) throw std::invalid_argument("alignHorn needs finite points");

  Similarity to_T_from;
  if (coincide(source) || coincide(target)) {
    to_T_from.translation = target.rowwise().mean() - source.rowwise().mean();
    return to_T_from;
  }
  const Eigen::Matrix4d transform = Eigen::umeyama(source, target, with_scale);
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const double scale = with_scale ? std::cbrt(linear.determinant()) : 1.0;
  // The two sets are uncorrelated, or one is so small that its variance is 0.
  if (!(scale > 0 && std::isfinite(scale) && transform.allFinite())) {
    to_T_from.translation = target.rowwise().mean() - source.rowwise().mean();
    return to_T_from;
  }
  to_T_from.scale = scale;
  to_T_from.rotation = Eigen::Quaterniond(Eigen::Matrix3d(linear / scale)).normalized();
  to_T_from.translation = transform.topRightCorner<3, 1>();
  return to_T_from;
}

}  // namespace edgeslam
