// P5: a warped window's samples have the same bits on every instruction set.
#include "flow/warped_window.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "unit/image/every_target.h"
#include "unit/image/kernel_images.h"

namespace edgeslam {
namespace {

constexpr int border = 40;  // farther than any of the windows below reaches [px]

// The part that has a meaning.
std::vector<std::int16_t> samplesOf(const SampledWindow& window, int side) {
  std::vector<std::int16_t> samples;
  for (int row = 0; row < side + 2; ++row) {
    for (int column = 0; column < side + 2; ++column) {
      samples.push_back(window[static_cast<std::size_t>(row * window_row + column)]);
    }
  }
  return samples;
}

WarpedGrid randomGrid(const cv::Size& size, std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return static_cast<std::int32_t>((low + (high - low) * static_cast<double>(random()) / 4294967296.0) * (1 << 16));
  };
  WarpedGrid grid;
  grid.x = between(0, size.width - 1);
  grid.y = between(0, size.height - 1);
  for (std::int32_t* part : {&grid.x_by_column, &grid.y_by_column, &grid.x_by_row, &grid.y_by_row}) {
    *part = between(-2, 2);
  }
  return grid;
}

TEST(WarpedWindow, HasTheReferencesBitsOnEveryInstructionSet) {
  const std::vector<cv::Mat> images = kernelImages(border);
  onEveryTarget([&] {
    std::mt19937 random(6);
    for (const cv::Mat& image : images) {
      for (const int side : {1, 5, 8, 11, 15}) {
        const WarpedGrid grid = randomGrid(image.size(), random);
        SampledWindow window{}, expected{};
        sampleWarpedWindow(image.data, static_cast<std::ptrdiff_t>(image.step[0]), grid, side, window);
        sampleWarpedWindowReference(image.data, static_cast<std::ptrdiff_t>(image.step[0]), grid, side, expected);
        ASSERT_EQ(samplesOf(window, side), samplesOf(expected, side)) << image.size() << " " << side;
      }
    }
  });
}

TEST(WarpedWindow, WithoutAWarpIsThePlainWindow) {
  const cv::Mat image = kernelImages(border)[40];
  const auto step = static_cast<std::ptrdiff_t>(image.step[0]);
  constexpr int side = 15;
  WarpedGrid grid;
  grid.x = 20 * (1 << 16) + (3 << 14);
  grid.y = 17 * (1 << 16) + (1 << 14);
  SampledWindow warped{}, plain{};
  sampleWarpedWindow(image.data, step, grid, side, warped);
  sampleWindow(image.data + (17 - 8) * step + 20 - 8, step, bilinearWeights(0.75f, 0.25f), side, plain);
  EXPECT_EQ(samplesOf(warped, side), samplesOf(plain, side));
}

}  // namespace
}  // namespace edgeslam
