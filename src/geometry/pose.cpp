#include "geometry/pose.h"

namespace edgeslam {

Eigen::Vector3d rotationLog(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation.w() < 0 ? Eigen::Quaterniond(-rotation.coeffs()) : rotation);
  return angle_axis.angle() * angle_axis.axis();
}

}  // namespace edgeslam
