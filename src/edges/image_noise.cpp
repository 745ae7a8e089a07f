#include "edges/image_noise.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <numeric>

namespace edgeslam {
namespace {

constexpr int sampling_step = 4;  // every fourth pixel of every fourth row is enough
constexpr double most_noise = 32;
constexpr double deviation_of_median = 1.4826;  // of a Gaussian: standard deviation over median absolute value
constexpr double gain_of_differences = 6;       // standard deviation of the second differences over that of a pixel

// [1 -2 1; -2 4 -2; 1 -2 1] around the pixel `at` points to: 0 on planes, and along straight level or upright edges.
int secondDifferences(const uint8_t* at, std::ptrdiff_t row) {
  const auto along_row = [](const uint8_t* middle) { return middle[-1] - 2 * middle[0] + middle[1]; };
  return along_row(at - row) - 2 * along_row(at) + along_row(at + row);
}

// Of whole numbers, of which `counts` says how many there are of each; between them as if each were spread evenly over
// half a unit on either side.
double medianOf(const std::array<int, 2041>& counts) {
  const double half = 0.5 * std::accumulate(counts.begin(), counts.end(), 0);
  double below = 0;
  for (size_t value = 0; value < counts.size(); ++value) {
    if (below + counts[value] >= half && counts[value] > 0) {
      const double within = (half - below) / counts[value];
      // Zero stands for the half of its unit that absolute values have.
      return value == 0 ? 0.5 * within : static_cast<double>(value) - 0.5 + within;
    }
    below += counts[value];
  }
  return 0;
}

}  // namespace

double gradientNoise(const cv::Mat& grey, const CameraMask* mask) {
  std::array<int, 2041> counts{};  // of absolute second differences
  const auto row = static_cast<std::ptrdiff_t>(grey.step1());
  for (int y = 1; y < grey.rows - 1; y += sampling_step) {
    const uint8_t* pixels = grey.ptr<uint8_t>(y);
    const uint8_t* hidden = mask ? mask->hidden.ptr<uint8_t>(y) : nullptr;
    for (int x = 1; x < grey.cols - 1; x += sampling_step) {
      if (hidden && hidden[x] != 0) continue;
      ++counts[static_cast<size_t>(std::abs(secondDifferences(pixels + x, row)))];
    }
  }
  const double deviation = medianOf(counts) * deviation_of_median / gain_of_differences;
  return std::min(0.5 * deviation * deviation, most_noise);
}

}  // namespace edgeslam
