#include "image/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace edgeslam {
namespace {

constexpr double kLeastSigma = 0.05;  // narrower than this a Gaussian is a single pixel [px]

cv::Mat gaussian(const cv::Mat& image, double sigma) {
  if (image.empty() || sigma < kLeastSigma) return image.clone();
  const int radius = std::max(1, static_cast<int>(std::lround(2.9 * sigma)));
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, cv::Size(2 * radius + 1, 2 * radius + 1), sigma, sigma, cv::BORDER_REPLICATE);
  return blurred;
}

}  // namespace

cv::Mat blurGrey(const cv::Mat& grey, double sigma) {
  CV_Assert(grey.type() == CV_8U);
  cv::Mat scaled;
  grey.convertTo(scaled, CV_16U, kBlurScale);
  return gaussian(scaled, sigma);
}

cv::Mat blurFurther(const cv::Mat& blurred, double sigma, double wider_sigma) {
  CV_Assert(blurred.empty() || blurred.type() == CV_16U);
  return gaussian(blurred, std::sqrt(std::max(0.0, wider_sigma * wider_sigma - sigma * sigma)));
}

}  // namespace edgeslam
