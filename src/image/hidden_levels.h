// Where the levels of an image pyramid show what is masked.
#pragma once

#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

// One entry a level of buildPyramid's: CV_8U of its size, 255 where a window of `radius` [px of the level] around the
// pixel sees what is masked, else 0. Empty: nothing is masked.
using HiddenLevels = std::vector<cv::Mat>;

// Of a mask of the image (CV_8U, 255 where masked, else 0).
HiddenLevels hiddenLevels(const cv::Mat& masked, int level_count, int radius);

// At a pixel of a level; of those outside the image, at the nearest inside.
inline bool isHiddenAt(const HiddenLevels& hidden, std::size_t level, float x, float y) {
  if (level >= hidden.size()) return false;
  const cv::Mat& image = hidden[level];
  const int column = std::min(std::max(cvRound(x), 0), image.cols - 1);
  const int row = std::min(std::max(cvRound(y), 0), image.rows - 1);
  return image.at<unsigned char>(row, column) != 0;
}

}  // namespace edgeslam
