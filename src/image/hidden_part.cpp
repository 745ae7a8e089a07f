#include "image/hidden_part.h"

#include <opencv2/imgproc.hpp>

namespace edgeslam {

cv::Mat hiddenPart(const cv::Mat& hidden, const cv::Size& size) {
  cv::Mat share;
  cv::resize(hidden, share, size, 0, 0, cv::INTER_AREA);
  return share > 0;
}

void fillHidden(const cv::Mat& hidden, double sigma, cv::Mat& image) {
  constexpr double least_weight = 1e-4;
  const cv::Mat seen = hidden == 0;
  cv::Mat weights(image.size(), CV_32F, cv::Scalar(1)), sums = image.clone();
  weights.setTo(0, hidden);
  sums.setTo(0, hidden);
  cv::GaussianBlur(weights, weights, {}, sigma, sigma, cv::BORDER_REFLECT_101);
  cv::GaussianBlur(sums, sums, {}, sigma, sigma, cv::BORDER_REFLECT_101);
  cv::Mat around = sums / cv::max(weights, least_weight);
  around.setTo(cv::mean(image, seen), weights < least_weight);
  around.copyTo(image, hidden);
}

}  // namespace edgeslam
