#include "geometry/one_to_one.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgeslam {

double farthestCorner(const Camera& camera) {
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  return std::hypot(x, y);
}

bool isOneToOne(const Camera& camera) {
  constexpr int steps = 200;
  constexpr double least_slope = 0.2, farthest_times = 3;
  const bool is_fisheye = camera.model == CameraModel::kannala_brandt;
  const std::array<double, 5>& k = camera.distortion;
  const std::array<double, 4> radial{k[0], k[1], is_fisheye ? k[2] : k[4], is_fisheye ? k[3] : 0};
  const double farthest = farthestCorner(camera);
  for (int i = 1; i <= steps; ++i) {
    const double r = farthest_times * farthest * i / steps, r2 = r * r;
    const double slope = 1 + r2 * (3 * radial[0] + r2 * (5 * radial[1] + r2 * (7 * radial[2] + r2 * 9 * radial[3])));
    if (!(slope > least_slope)) return false;
    if (r * (1 + r2 * (radial[0] + r2 * (radial[1] + r2 * (radial[2] + r2 * radial[3])))) > farthest) return true;
  }
  return false;
}

}  // namespace edgeslam
