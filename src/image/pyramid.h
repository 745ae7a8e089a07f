// Grey image pyramid, halved by a 5x5 Gaussian: pixel (x, y) of level 0 lies at (x, y) / 2^l in level l.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

// Pixels that may be read outside each level's image (mirrored content), so that windows need no bounds checks [px].
constexpr int pyramid_border = 24;

struct ImagePyramid {
  std::vector<cv::Mat> levels;  // CV_8U, each a view into a larger image with pyramid_border pixels around
};

// `grey` is CV_8U. Stops early where a level would be smaller than 16 pixels. The memory of `pyramid` is used again
// where it has the right size, so that a pyramid of the same size is built without any allocation; whoever else holds
// its levels sees them change. `grey` may not be one of them.
void buildPyramid(const cv::Mat& grey, int level_count, ImagePyramid& pyramid);

// A pyramid in memory of its own.
ImagePyramid buildPyramid(const cv::Mat& grey, int level_count);

}  // namespace edgeslam
