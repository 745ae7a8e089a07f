// Similarity transformations Sim(3) and Horn's method (1987) for them: loop verification (P26) and evaluation.
#pragma once

#include <vector>

#include "geometry/rolling_shutter.h"

namespace edgeslam {

struct Similarity {
  double scale = 1;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return scale * (rotation * p) + translation; }
  Similarity operator*(const Similarity& other) const {
    return {scale * other.scale, (rotation * other.rotation).normalized(),
            scale * (rotation * other.translation) + translation};
  }
  Similarity inverse() const {
    const Eigen::Quaterniond r = rotation.conjugate();
    return {1.0 / scale, r, -(r * translation) / scale};
  }
};

// A camera that a similarity moves along with its surroundings.
inline Pose moved(const Similarity& new_S_old, const Pose& old_T_camera) {
  return {(new_S_old.rotation * old_T_camera.rotation).normalized(), new_S_old * old_T_camera.translation};
}

// And its motion: seen from itself it only becomes faster.
inline Twist moved(const Similarity& new_S_old, const Twist& twist) {
  Twist faster = twist;
  faster.head<3>() *= new_S_old.scale;
  return faster;
}

// Least-squares similarity with to ~ scale * R * from + t. `with_scale` false keeps the scale at 1. Needs at least 3
// points that do not lie on one line for a unique rotation; otherwise one of the best is returned, and a mere
// translation where all points of a set coincide. Throws std::invalid_argument where sizes differ or are 0 or a point
// is not finite.
Similarity alignHorn(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                     bool with_scale = true);

}  // namespace edgeslam
