#include "inertia/inertial_alignment.h"

namespace edgeslam {

Eigen::Quaterniond uprightRotation(const InertialAlignment& alignment) {
  return Eigen::Quaterniond::FromTwoVectors(-alignment.gravity, Eigen::Vector3d::UnitZ());
}

InertialAlignment moved(const Similarity& new_S_old, const InertialAlignment& alignment) {
  InertialAlignment now = alignment;
  now.metres_a_unit /= new_S_old.scale;
  now.gravity = new_S_old.rotation * alignment.gravity;
  return now;
}

}  // namespace edgeslam
