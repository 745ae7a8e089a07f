// P17: depth of a point from two or more views, only where the epipolar line crosses the edge at an angle. The point is
// host bearing f (unit) and inverse distance rho: X_host = f / rho; in another camera, up to scale,
// X = R f + rho t with other_T_host = (R, t).
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"

namespace edgeslam {

struct TriangulationView {
  Pose view_T_host;
  Measurement measurement;
};

struct TriangulationResult {
  bool converged = false;    // a minimum in front of the host and of all other cameras, not at infinity, was found
  double inverse_depth = 0;  // [1 / map unit], along the unit bearing
  // Standard deviation of the inverse depth, from the measurements' information projected on the epipolar direction:
  // large where the epipolar line runs along the edge, infinite without a baseline. The host bearing is taken as exact.
  double sigma = 0;
  double parallax = 0;       // largest angle [rad] between the rays of the host and of a view
  double largest_error = 0;  // largest whitened reprojection error over the views (norm of 2)
};

// Gauss-Newton on the inverse depth over all views, without allocation. Starts from `initial_inverse_depth` where that
// is positive, else from the best of what each view alone asks for and of a few depths with 0 to 60 degrees of
// parallax.
TriangulationResult triangulate(const Camera& camera, const Eigen::Vector3d& host_bearing,
                                const std::vector<TriangulationView>& views, double initial_inverse_depth = 0);

}  // namespace edgeslam
