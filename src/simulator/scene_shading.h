// What a point of a scene's rectangle looks like: its albedo, its texture and the light upon it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "simulator/scene.h"

namespace edgeslam {

// A scene with its light.
struct LitScene {
  Scene scene;
  std::vector<cv::Mat> light;  // computeLight(scene)
};

// A rectangle at one resolution. Refers to the scene's light and textures.
struct Surface {
  const float* light = nullptr;  // nodes, row by row
  int light_columns = 0;
  float light_s = 0, light_t = 0;  // number of intervals between nodes
  const unsigned char* texels = nullptr;
  int texel_step = 0;                // from row to row
  float texels_s = 0, texels_t = 0;  // number of texels
  float albedo = 0;
};

// `pixel_m`: size of an image pixel on the surface, were it seen squarely [m].
Surface surfaceOf(const LitScene& lit, int rectangle, float pixel_m);

// Between four neighbours of a grid whose rows are `step` apart; x in [0, columns - 1), y likewise.
template <typename Value>
float interpolate(const Value* data, int step, float x, float y) {
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float fraction_x = x - static_cast<float>(column), fraction_y = y - static_cast<float>(row);
  const Value* p = data + static_cast<std::ptrdiff_t>(row) * step + column;
  const float p00 = static_cast<float>(p[0]), p10 = static_cast<float>(p[1]);
  const float p01 = static_cast<float>(p[step]), p11 = static_cast<float>(p[step + 1]);
  const float upper = p00 + fraction_x * (p10 - p00), lower = p01 + fraction_x * (p11 - p01);
  return upper + fraction_y * (lower - upper);
}

// Radiance of the point (s, t), both in [0, 1].
inline float shade(const Surface& surface, float s, float t) {
  const float inside_s = std::clamp(s, 0.0F, 0.99999F), inside_t = std::clamp(t, 0.0F, 0.99999F);
  const float radiance = surface.albedo * interpolate(surface.light, surface.light_columns, inside_s * surface.light_s,
                                                      inside_t * surface.light_t);
  if (!surface.texels) return radiance;
  // Texel centres lie at (i + 0.5) / count.
  const float x = std::clamp(s * surface.texels_s - 0.5F, 0.0F, surface.texels_s - 1.001F);
  const float y = std::clamp(t * surface.texels_t - 0.5F, 0.0F, surface.texels_t - 1.001F);
  return radiance / 255.0F * interpolate(surface.texels, surface.texel_step, x, y);
}

}  // namespace edgeslam
