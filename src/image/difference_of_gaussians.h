// P1: an image blurred by a Gaussian, and what a wider Gaussian takes from it. All in integers that are exact up to one
// rounding a blur, so that edges are the same on every processor.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "image/fixed_gaussian.h"

namespace edgeslam {

// A blurred value of blur_scale is one grey value; the largest, 255 * blur_scale, fits a signed 16-bit integer.
constexpr int blur_scale = 128;

// Memory to be used for one image after the other.
struct DifferenceOfGaussians {
  cv::Mat narrow;  // CV_16U, the image blurred by the narrower Gaussian [grey / blur_scale]
  cv::Mat dog;     // CV_16S, that less the image blurred by the wider one [grey / blur_scale]

  double sigma = 0;  // those of the kernels below
  double sigma_ratio = 0;
  FixedGaussian to_narrow;
  FixedGaussian to_wide;  // from the narrower blur
  // For one row of the image: the rows of pixels around it, and the sums over them; the vectors' in two parts.
  std::vector<const uint8_t*> rows;
  std::vector<int16_t> upper;
  std::vector<int16_t> lower;
  std::vector<uint64_t> sums;
};

// Blurs `grey` (CV_8U) by Gaussians of standard deviation `sigma` >= 0 [px] and `sigma_ratio` >= 1 times that, and
// takes the difference; beyond the image its outermost pixels go on. Allocates where `result` was not used for an image
// of this size with these Gaussians.
void differenceOfGaussians(const cv::Mat& grey, double sigma, double sigma_ratio, DifferenceOfGaussians& result);

// What differenceOfGaussians gives, one pixel after the other.
void differenceOfGaussiansReference(const cv::Mat& grey, double sigma, double sigma_ratio,
                                    DifferenceOfGaussians& result);

// Shapes the memory of `result`: what differenceOfGaussians and its reference do first.
void prepareDifferenceOfGaussians(const cv::Size& size, double sigma, double sigma_ratio,
                                  DifferenceOfGaussians& result);

}  // namespace edgeslam
