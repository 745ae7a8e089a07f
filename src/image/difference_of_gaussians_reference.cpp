#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "image/difference_of_gaussians.h"

namespace edgeslam {
namespace {

uint64_t weightOf(const FixedGaussian& gaussian, int k) {
  return static_cast<uint64_t>(gaussian.weights[static_cast<size_t>(std::abs(k))]);
}

// Row y of `image` times `scale`, blurred; rounded once.
template <typename Pixel>
void blurRow(const cv::Mat& image, uint64_t scale, const FixedGaussian& gaussian, int y, std::vector<uint64_t>& columns,
             uint16_t* row) {
  const int radius = gaussian.radius();
  columns.assign(static_cast<size_t>(image.cols), 0);
  for (int k = -radius; k <= radius; ++k) {
    const auto* from = image.ptr<Pixel>(std::clamp(y + k, 0, image.rows - 1));
    for (int x = 0; x < image.cols; ++x) columns[static_cast<size_t>(x)] += weightOf(gaussian, k) * scale * from[x];
  }
  constexpr int shift = 2 * weight_bits;
  for (int x = 0; x < image.cols; ++x) {
    uint64_t sum = uint64_t{1} << (shift - 1);
    for (int k = -radius; k <= radius; ++k) {
      sum += weightOf(gaussian, k) * columns[static_cast<size_t>(std::clamp(x + k, 0, image.cols - 1))];
    }
    row[x] = static_cast<uint16_t>(sum >> shift);
  }
}

}  // namespace

void prepareDifferenceOfGaussians(const cv::Size& size, double sigma, double sigma_ratio,
                                  DifferenceOfGaussians& result) {
  assert(sigma >= 0 && sigma_ratio >= 1);
  if (sigma != result.sigma || sigma_ratio != result.sigma_ratio) {
    result.sigma = sigma;
    result.sigma_ratio = sigma_ratio;
    result.to_narrow = fixedGaussian(sigma);
    result.to_wide = fixedGaussian(sigma * std::sqrt(std::max(0.0, sigma_ratio * sigma_ratio - 1)));
  }
  result.narrow.create(size, CV_16U);
  result.dog.create(size, CV_16S);
  const auto width = static_cast<size_t>(size.width);
  const auto diameter = static_cast<size_t>(2 * std::max(result.to_narrow.radius(), result.to_wide.radius()) + 1);
  result.rows.reserve(diameter);
  result.upper.resize(width + diameter);
  result.lower.resize(width + diameter);
  result.sums.reserve(width);
}

void differenceOfGaussiansReference(const cv::Mat& grey, double sigma, double sigma_ratio,
                                    DifferenceOfGaussians& result) {
  CV_Assert(grey.type() == CV_8U && !grey.empty());
  prepareDifferenceOfGaussians(grey.size(), sigma, sigma_ratio, result);
  for (int y = 0; y < grey.rows; ++y) {
    blurRow<uint8_t>(grey, blur_scale, result.to_narrow, y, result.sums, result.narrow.ptr<uint16_t>(y));
  }
  for (int y = 0; y < grey.rows; ++y) {
    auto* dog = result.dog.ptr<uint16_t>(y);
    blurRow<uint16_t>(result.narrow, 1, result.to_wide, y, result.sums, dog);
    const auto* narrow = result.narrow.ptr<uint16_t>(y);
    for (int x = 0; x < grey.cols; ++x) dog[x] = static_cast<uint16_t>(narrow[x] - dog[x]);
  }
}

}  // namespace edgeslam
