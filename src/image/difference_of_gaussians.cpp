#include "image/difference_of_gaussians.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr int kScaleBits = 7;
static_assert(1 << kScaleBits == kBlurScale);

// `blurred` (CV_16U) is `image` times 1 << `scale_bits`, blurred; rounded once.
template <typename Pixel>
void blur(const cv::Mat& image, int scale_bits, const FixedGaussian& gaussian, std::vector<uint32_t>& sums,
          cv::Mat& blurred) {
  const int radius = gaussian.radius();
  const int last_row = image.rows - 1;
  const int last_column = image.cols - 1;
  const int shift = 2 * kWeightBits - scale_bits;
  for (int y = 0; y < image.rows; ++y) {
    std::fill(sums.begin(), sums.end(), 0U);
    for (int k = -radius; k <= radius; ++k) {
      const auto weight = static_cast<uint32_t>(gaussian.weights[static_cast<size_t>(std::abs(k))]);
      const auto* row = image.ptr<Pixel>(std::clamp(y + k, 0, last_row));
      for (int x = 0; x < image.cols; ++x) sums[static_cast<size_t>(x)] += weight * row[x];
    }
    auto* to = blurred.ptr<uint16_t>(y);
    for (int x = 0; x < image.cols; ++x) {
      uint64_t sum = uint64_t{1} << (shift - 1);
      for (int k = -radius; k <= radius; ++k) {
        const auto weight = static_cast<uint64_t>(gaussian.weights[static_cast<size_t>(std::abs(k))]);
        sum += weight * sums[static_cast<size_t>(std::clamp(x + k, 0, last_column))];
      }
      to[x] = static_cast<uint16_t>(sum >> shift);
    }
  }
}

void prepare(const cv::Size& size, double sigma, double sigma_ratio, DifferenceOfGaussians& result) {
  if (sigma != result.sigma || sigma_ratio != result.sigma_ratio) {
    result.sigma = sigma;
    result.sigma_ratio = sigma_ratio;
    result.to_narrow = fixedGaussian(sigma);
    result.to_wide = fixedGaussian(sigma * std::sqrt(std::max(0.0, sigma_ratio * sigma_ratio - 1)));
  }
  result.sums.resize(static_cast<size_t>(size.width));
  result.narrow.create(size, CV_16U);
  result.wide.create(size, CV_16U);
  result.dog.create(size, CV_16S);
}

}  // namespace

void differenceOfGaussians(const cv::Mat& grey, double sigma, double sigma_ratio, DifferenceOfGaussians& result) {
  CV_Assert(grey.type() == CV_8U && !grey.empty());
  prepare(grey.size(), sigma, sigma_ratio, result);
  blur<uint8_t>(grey, kScaleBits, result.to_narrow, result.sums, result.narrow);
  blur<uint16_t>(result.narrow, 0, result.to_wide, result.sums, result.wide);
  for (int y = 0; y < grey.rows; ++y) {
    const auto* narrow = result.narrow.ptr<uint16_t>(y);
    const auto* wide = result.wide.ptr<uint16_t>(y);
    auto* dog = result.dog.ptr<int16_t>(y);
    for (int x = 0; x < grey.cols; ++x) dog[x] = static_cast<int16_t>(narrow[x] - wide[x]);
  }
}

}  // namespace edgeslam
