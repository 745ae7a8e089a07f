#include "image/hidden_levels.h"

#include <opencv2/imgproc.hpp>

#include "image/pyramid.h"

namespace edgeslam {
namespace {

constexpr int visible_share = 12;  // of 255: what makes up less of a pixel does not show

}  // namespace

HiddenLevels hiddenLevels(const cv::Mat& masked, int level_count, int radius) {
  const cv::Mat window = cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
  HiddenLevels hidden;
  for (const cv::Mat& level : buildPyramid(masked, level_count).levels) {
    cv::dilate(level > visible_share, hidden.emplace_back(), window);
  }
  return hidden;
}

}  // namespace edgeslam
