// Worked out on planes through the middle camera's centre rather than on lines in its image, so that it holds for any
// camera model: an epipolar line is such a plane, and two of them cross in a bearing.
#include "geometry/three_view_check.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

const double least_crossing = std::sin(radians(2));  // planes that cross at less are taken as parallel

struct EpipolarPlane {
  bool exists = false;      // false without a baseline, or for a pixel at the epipole
  Eigen::Vector3d normal;   // unit, in the middle camera's frame
  Eigen::Vector3d bearing;  // the other view's, turned into the middle camera's frame
};

EpipolarPlane epipolarPlane(const Camera& camera, const Pose& middle_T_other, const Eigen::Vector2d& other_pixel) {
  EpipolarPlane plane;
  plane.bearing = middle_T_other.rotation * bearing(camera, other_pixel);
  const double baseline = middle_T_other.translation.norm();
  if (!(baseline > 1e-12)) return plane;
  const Eigen::Vector3d normal = (middle_T_other.translation / baseline).cross(plane.bearing);
  const double length = normal.norm();
  if (!(length > 1e-6)) return plane;
  plane.normal = normal / length;
  plane.exists = true;
  return plane;
}

// Whitened distance of the measured pixel from a predicted bearing; infinite where that points backwards.
double distanceToBearing(const Camera& camera, const Eigen::Vector3d& predicted, const Measurement& measurement) {
  if (camera.model == CameraModel::pinhole_radial_tangential && predicted.z() <= 1e-6 * predicted.norm()) {
    return std::numeric_limits<double>::infinity();
  }
  return (whitening(measurement) * (project(camera, predicted) - measurement.pixel)).norm();
}

// Whitened (Mahalanobis) distance of the measured pixel from an epipolar line, to first order. With c = normal .
// bearing and g = d c / d pixel, it is |c| / sqrt(g^T covariance g).
double distanceToPlane(const Camera& camera, const Eigen::Vector3d& normal, const Measurement& measurement) {
  const Eigen::Vector3d measured = bearing(camera, measurement.pixel);
  Eigen::Matrix<double, 2, 3> pixel_by_bearing;
  project(camera, measured, &pixel_by_bearing);
  const Eigen::Matrix2d squared = pixel_by_bearing * pixel_by_bearing.transpose();
  const Eigen::Vector2d gradient = squared.inverse() * (pixel_by_bearing * normal);
  const Eigen::Vector2d spread = whitening(measurement).inverse().transpose() * gradient;
  return std::abs(normal.dot(measured)) / spread.norm();
}

}  // namespace

double threeViewError(const Camera& camera, const Pose& world_T_first, const Pose& world_T_middle,
                      const Pose& world_T_last, const Eigen::Vector2d& first_pixel, const Measurement& middle,
                      const Eigen::Vector2d& last_pixel) {
  const Pose middle_T_world = world_T_middle.inverse();
  const EpipolarPlane first = epipolarPlane(camera, middle_T_world * world_T_first, first_pixel);
  const EpipolarPlane last = epipolarPlane(camera, middle_T_world * world_T_last, last_pixel);
  if (!first.exists || !last.exists) {
    // Without a baseline the bearing itself is predicted.
    const double first_error =
        first.exists ? distanceToPlane(camera, first.normal, middle) : distanceToBearing(camera, first.bearing, middle);
    const double last_error =
        last.exists ? distanceToPlane(camera, last.normal, middle) : distanceToBearing(camera, last.bearing, middle);
    return std::max(first_error, last_error);
  }
  Eigen::Vector3d crossing = first.normal.cross(last.normal);
  if (crossing.norm() < least_crossing) {
    return std::max(distanceToPlane(camera, first.normal, middle), distanceToPlane(camera, last.normal, middle));
  }
  if (crossing.dot(bearing(camera, middle.pixel)) < 0) crossing = -crossing;
  return distanceToBearing(camera, crossing, middle);
}

}  // namespace edgeslam
