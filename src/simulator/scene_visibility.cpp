#include "simulator/scene_visibility.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace edgeslam {
namespace {

bool mayHit(const SeenRectangle& r, const RayBox& box) {
  return largest(r.s, box) >= 0 && largest(r.t, box) >= 0 && largest(r.s_left, box) >= 0 &&
         largest(r.t_left, box) >= 0 && largest(r.inverse_depth, box) > 0;
}

bool mustHit(const SeenRectangle& r, const RayBox& box) {
  return smallest(r.s, box) >= 0 && smallest(r.t, box) >= 0 && smallest(r.s_left, box) >= 0 &&
         smallest(r.t_left, box) >= 0 && smallest(r.inverse_depth, box) > 0;
}

}  // namespace

std::vector<SeenRectangle> seenFrom(const Scene& scene, const Pose& world_T_camera) {
  const Pose camera_T_world = world_T_camera.inverse();
  std::vector<SeenRectangle> seen;
  for (std::size_t i = 0; i < scene.rectangles.size(); ++i) {
    const SceneRectangle& r = scene.rectangles[i];
    Eigen::Matrix3d camera_by_rectangle;
    camera_by_rectangle.col(0) = camera_T_world.rotation * r.side_s;
    camera_by_rectangle.col(1) = camera_T_world.rotation * r.side_t;
    camera_by_rectangle.col(2) = camera_T_world * r.corner;
    // The determinant is the camera's height over the rectangle's plane, negative in front of it, times the area.
    const double area = r.side_s.cross(r.side_t).norm();
    if (-camera_by_rectangle.determinant() < 1e-6 * area) continue;
    const Eigen::Matrix3f inverse = camera_by_rectangle.inverse().cast<float>();
    const auto row = [&inverse](int k) { return LinearFunction{inverse(k, 0), inverse(k, 1), inverse(k, 2)}; };
    seen.push_back({row(0), row(1), row(2) - row(0), row(2) - row(1), row(2), static_cast<int>(i)});
  }
  return seen;
}

bool findFirstHits(const std::vector<const SeenRectangle*>& seen, const RayBox& box,
                   std::vector<const SeenRectangle*>& first_hits) {
  first_hits.clear();
  std::vector<const SeenRectangle*> covers;
  for (const SeenRectangle* r : seen) {
    if (!mayHit(*r, box)) continue;
    first_hits.push_back(r);
    if (mustHit(*r, box)) covers.push_back(r);
  }
  for (const SeenRectangle* cover : covers) {
    const auto hidden = [&](const SeenRectangle* r) {
      return r != cover && smallest(cover->inverse_depth - r->inverse_depth, box) > 0;
    };
    first_hits.erase(std::remove_if(first_hits.begin(), first_hits.end(), hidden), first_hits.end());
  }
  return first_hits.size() == 1 && std::find(covers.begin(), covers.end(), first_hits.front()) != covers.end();
}

const SeenRectangle* firstHit(const std::vector<SeenRectangle>& seen, float u, float v) {
  const SeenRectangle* nearest = nullptr;
  float nearest_inverse_depth = 0;
  for (const SeenRectangle& r : seen) {
    const float inverse_depth = r.inverse_depth(u, v);
    if (inverse_depth <= nearest_inverse_depth || !mustHit(r, {u, v, 0, 0})) continue;
    nearest = &r;
    nearest_inverse_depth = inverse_depth;
  }
  return nearest;
}

}  // namespace edgeslam
