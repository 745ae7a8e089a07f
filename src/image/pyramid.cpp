#include "image/pyramid.h"

#include <opencv2/imgproc.hpp>

namespace edgeslam {
namespace {

// Copies the image into a larger one with a mirrored border and returns the view of the inner part.
cv::Mat withBorder(const cv::Mat& image) {
  cv::Mat larger;
  cv::copyMakeBorder(image, larger, pyramid_border, pyramid_border, pyramid_border, pyramid_border,
                     cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
  return larger(cv::Rect(pyramid_border, pyramid_border, image.cols, image.rows));
}

}  // namespace

ImagePyramid buildPyramid(const cv::Mat& grey, int level_count) {
  CV_Assert(grey.type() == CV_8U && !grey.empty());
  ImagePyramid pyramid;
  pyramid.levels.push_back(withBorder(grey));
  for (int level = 1; level < level_count; ++level) {
    const cv::Mat& finer = pyramid.levels.back();
    if (finer.cols < 32 || finer.rows < 32) break;
    cv::Mat coarser;
    cv::pyrDown(finer, coarser, cv::Size(), cv::BORDER_REFLECT_101);
    pyramid.levels.push_back(withBorder(coarser));
  }
  return pyramid;
}

}  // namespace edgeslam
