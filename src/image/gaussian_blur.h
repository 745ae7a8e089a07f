// P1: Gaussian blurs in fixed point. OpenCV's 16-bit blur is bit-exact, so edges are the same on every processor.
#pragma once

#include <opencv2/core/mat.hpp>

namespace edgeslam {

// A blurred value of kBlurScale is one grey value; the largest, 255 * kBlurScale, fits a signed 16-bit integer.
constexpr int kBlurScale = 128;

// `grey` (CV_8U) blurred with standard deviation `sigma` [px]; CV_16U, in grey values times kBlurScale.
cv::Mat blurGrey(const cv::Mat& grey, double sigma);

// What blurGrey gave, blurred further: from standard deviation `sigma` to `wider_sigma` >= sigma [px].
cv::Mat blurFurther(const cv::Mat& blurred, double sigma, double wider_sigma);

}  // namespace edgeslam
