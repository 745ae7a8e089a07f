#include "simulator/scene_rays.h"

#include <string>

#include "edgeslam/input_error.h"

namespace edgeslam {

RayTable makeRayTable(const Camera& camera) {
  RayTable rays;
  rays.width = camera.width;
  rays.height = camera.height;
  // One pixel more on each side, for the derivatives.
  const std::size_t stride = static_cast<std::size_t>(camera.width) + 2;
  std::vector<Eigen::Vector2d> directions;
  directions.reserve(stride * (static_cast<std::size_t>(camera.height) + 2));
  for (int y = -1; y <= camera.height; ++y) {
    for (int x = -1; x <= camera.width; ++x) {
      const Eigen::Vector3d direction = bearing(camera, Eigen::Vector2d(x, y));
      const bool in_front = direction.allFinite() && direction.z() > 1e-3;
      if (!in_front || (project(camera, direction) - Eigen::Vector2d(x, y)).norm() > 1e-3) {
        throw InputError("camera: the distortion cannot be inverted at pixel (" + std::to_string(x) + ", " +
                         std::to_string(y) + ")");
      }
      directions.emplace_back(direction.head<2>() / direction.z());
    }
  }
  for (std::size_t y = 1; y <= static_cast<std::size_t>(camera.height); ++y) {
    for (std::size_t x = 1; x <= static_cast<std::size_t>(camera.width); ++x) {
      const std::size_t i = y * stride + x;
      const Eigen::Vector2d by_x = 0.5 * (directions[i + 1] - directions[i - 1]);
      const Eigen::Vector2d by_y = 0.5 * (directions[i + stride] - directions[i - stride]);
      rays.u.push_back(static_cast<float>(directions[i].x()));
      rays.v.push_back(static_cast<float>(directions[i].y()));
      rays.u_by_x.push_back(static_cast<float>(by_x.x()));
      rays.u_by_y.push_back(static_cast<float>(by_y.x()));
      rays.v_by_x.push_back(static_cast<float>(by_x.y()));
      rays.v_by_y.push_back(static_cast<float>(by_y.y()));
    }
  }
  return rays;
}

}  // namespace edgeslam
