// The residual of a straight line of space that is seen in a direction: the sine of the angle between the ray and the
// plane through camera and line, whitened; and its derivatives. A ray tells nothing of where along the line it meets
// it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/space_line.h"

namespace edgeslam {

// By what a residual depends on, world axes.
struct LineDerivatives {
  Eigen::Vector3d by_point;      // of the line [1 / map unit]; the negative of that by the camera's centre
  Eigen::Vector3d by_direction;  // of the line [1 / rad]
  Eigen::Vector3d by_turn;       // of the camera about its centre [1 / rad]: exp(turn) * world_R_camera
};

// Residual of a line (world frame) that a camera at `centre` sees along `ray` (unit, world axes) with the standard
// deviation `sigma` [rad] across the line, and its derivatives where asked for. False, with nothing written, where the
// line is seen end-on: it or its point is at the camera, so that there is no plane.
inline bool lineResidual(const SpaceLine& line, const Eigen::Vector3d& centre, const Eigen::Vector3d& ray, double sigma,
                         double& residual, LineDerivatives* derivatives) {
  // Less than this from end-on the whole line is as good as a point of the image.
  constexpr double least_sine = 1e-3;
  const Eigen::Vector3d to_point = line.point - centre;
  const Eigen::Vector3d moment = to_point.cross(line.direction);
  const double length = moment.norm();
  if (!(length > least_sine * to_point.norm())) return false;
  const Eigen::Vector3d normal = moment / length;
  const double sine = normal.dot(ray);
  residual = sine / sigma;
  if (!derivatives) return true;
  const Eigen::Vector3d by_moment = (ray - sine * normal) / (length * sigma);
  derivatives->by_point = line.direction.cross(by_moment);
  derivatives->by_direction = by_moment.cross(to_point);
  derivatives->by_turn = ray.cross(normal) / sigma;
  return true;
}

}  // namespace edgeslam
