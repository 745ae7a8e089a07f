#include "simulator/scene_shading.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
Surface surfaceOf(const LitScene& lit, int rectangle, float pixel_m) {
  const std::size_t index = static_cast<std::size_t>(rectangle);
  const SceneRectangle& r = lit.scene.rectangles[index];
  const cv::Mat& light = lit.light[index];
  Surface surface;
  surface.light = light.ptr<float>();
  surface.light_columns = light.cols;
  surface.light_s = static_cast<float>(light.cols - 1);
  surface.light_t = static_cast<float>(light.rows - 1);
  surface.albedo = r.emission > 0 ? 1.0F : static_cast<float>(r.albedo);
  if (r.texture < 0) return surface;
  const std::vector<cv::Mat>& levels = lit.scene.textures[static_cast<std::size_t>(r.texture)].levels;
  const float texels_a_pixel = static_cast<float>(levels.front().cols / r.side_s.norm()) * pixel_m;
  const int level = static_cast<int>(std::log2(std::max(1.0F, 0.8F * texels_a_pixel)));
  const cv::Mat& texels = levels[static_cast<std::size_t>(std::min(level, static_cast<int>(levels.size()) - 1))];
  surface.texels = texels.ptr<unsigned char>();
  surface.texel_step = static_cast<int>(texels.step);
  surface.texels_s = static_cast<float>(texels.cols);
  surface.texels_t = static_cast<float>(texels.rows);
  return surface;
}

}  // namespace edgeslam
