// Which of a scene's rectangles a ray hits first. A rectangle's coordinates over depth, (s, t, 1) / z, are a linear
// function of the undistorted ray (u, v, 1): three dot products tell whether it is hit, where, and how far away; and
// bounds of linear functions over a box of rays tell it for a whole piece of the image.
#pragma once

#include <cmath>
#include <vector>

#include "geometry/pose.h"
#include "simulator/scene.h"

namespace edgeslam {

// a u + b v + c
struct LinearFunction {
  float a = 0, b = 0, c = 0;
  float operator()(float u, float v) const { return a * u + b * v + c; }
};

inline LinearFunction operator-(const LinearFunction& f, const LinearFunction& g) {
  return {f.a - g.a, f.b - g.b, f.c - g.c};
}

// The rays with |u - middle| <= half_u and |v - middle| <= half_v.
struct RayBox {
  float u = 0, v = 0, half_u = 0, half_v = 0;
};

inline float largest(const LinearFunction& f, const RayBox& box) {
  return f(box.u, box.v) + std::abs(f.a) * box.half_u + std::abs(f.b) * box.half_v;
}
inline float smallest(const LinearFunction& f, const RayBox& box) {
  return f(box.u, box.v) - std::abs(f.a) * box.half_u - std::abs(f.b) * box.half_v;
}

// A rectangle as a camera sees it, all over the depth z of the ray's hit. Hit where 1 / z is positive and none of the
// others is negative.
struct SeenRectangle {
  LinearFunction s, t, s_left, t_left;  // s / z, t / z, (1 - s) / z, (1 - t) / z
  LinearFunction inverse_depth;         // 1 / z
  int index = 0;                        // in Scene::rectangles
};

// The rectangles that turn their front to the camera.
std::vector<SeenRectangle> seenFrom(const Scene& scene, const Pose& world_T_camera);

// Those of `seen` that some ray of the box may hit first. Returns true where it is one alone, which every ray hits.
bool findFirstHits(const std::vector<const SeenRectangle*>& seen, const RayBox& box,
                   std::vector<const SeenRectangle*>& first_hits);

// The rectangle that the ray hits first, or nullptr.
const SeenRectangle* firstHit(const std::vector<SeenRectangle>& seen, float u, float v);

}  // namespace edgeslam
