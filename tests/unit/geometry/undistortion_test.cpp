// Bearings of many pixels at a time have the bits of one after the other.
#include "geometry/undistortion.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "unit/geometry/scene_fixture.h"
#include "unit/image/every_target.h"

namespace edgeslam {
namespace {

class UndistortionOf : public testing::TestWithParam<NamedCamera> {};

INSTANTIATE_TEST_SUITE_P(Calibrations, UndistortionOf, testing::ValuesIn(cameras()),
                         [](const auto& tested) { return tested.param.name; });
INSTANTIATE_TEST_SUITE_P(FoldingCalibrations, UndistortionOf, testing::ValuesIn(foldingCameras()),
                         [](const auto& tested) { return tested.param.name; });

std::vector<Eigen::Vector2d> pixelsOf(const Camera& camera, std::size_t count) {
  Random random(3);
  std::vector<Eigen::Vector2d> pixels;
  for (std::size_t i = 0; i < count; ++i) {
    pixels.emplace_back(random.uniform(0, camera.width), random.uniform(0, camera.height));
  }
  if (count > 1) pixels[count / 2] = {camera.cx, camera.cy};
  return pixels;
}

TEST_P(UndistortionOf, HasTheBitsOfOneAfterTheOtherOnEveryTarget) {
  const Camera& camera = GetParam().camera;
  onEveryTarget([&] {
    for (const std::size_t count : {0, 1, 2, 3, 4, 7, 8, 9, 64, 1001}) {
      const std::vector<Eigen::Vector2d> pixels = pixelsOf(camera, count);
      std::vector<Eigen::Vector3d> bearings(count), expected(count);
      bearingsOf(camera, pixels.data(), count, bearings.data());
      bearingsReference(camera, pixels.data(), count, expected.data());
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(bearings[i], expected[i]) << count << " " << i;
    }
  });
}

TEST_P(UndistortionOf, OneBadPixelDoesNotHarmItsNeighbours) {
  const Camera& camera = GetParam().camera;
  onEveryTarget([&] {
    std::vector<Eigen::Vector2d> pixels = pixelsOf(camera, 24);
    std::vector<Eigen::Vector3d> bearings(24), expected(24);
    bearingsReference(camera, pixels.data(), 24, expected.data());
    pixels[3].x() = std::numeric_limits<double>::quiet_NaN();
    pixels[9].y() = std::numeric_limits<double>::infinity();
    pixels[17] = {1e200, -1e200};
    bearingsOf(camera, pixels.data(), 24, bearings.data());
    for (std::size_t i = 0; i < 24; ++i) {
      if (i == 3 || i == 9 || i == 17) continue;
      EXPECT_EQ(bearings[i], expected[i]) << i;
    }
  });
}

}  // namespace
}  // namespace edgeslam
