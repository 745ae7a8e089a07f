#include "drivers/frame_capture/exposure_regulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

constexpr ExposureRange range{1, 100, 0, 160};

// A sensor whose mean is `light` at an exposure of 100 and no gain, each 16 of gain being 1.25 times as bright.
FrameBrightness seen(double light, const ExposureSetting& setting) {
  const double mean = light * static_cast<double>(setting.exposure) / 100 * std::pow(1.25, double(setting.gain) / 16);
  return {std::min(mean, 255.0), mean > 250 ? 1.0 : mean > 200 ? 0.2 : 0.0};
}

ExposureSetting settled(double light, ExposureSetting setting) {
  for (int i = 0; i < 60; ++i) {
    setting = nextExposure(setting, range, seen(light, setting));
    EXPECT_LE(setting.exposure, range.longest_exposure);
    EXPECT_GE(setting.exposure, range.least_exposure);
    EXPECT_LE(setting.gain, range.largest_gain);
    EXPECT_GE(setting.gain, range.least_gain);
  }
  return setting;
}

TEST(ExposureRegulation, ComesToRestAtAGoodBrightnessFromAnywhere) {
  for (const double light : {20.0, 60.0, 110.0, 300.0, 2000.0}) {
    for (const ExposureSetting& start : {ExposureSetting{1, 0}, ExposureSetting{100, 160}, ExposureSetting{50, 80}}) {
      const ExposureSetting setting = settled(light, start);
      EXPECT_EQ(nextExposure(setting, range, seen(light, setting)), setting) << light;
      EXPECT_GE(seen(light, setting).mean, 75) << light;
      EXPECT_LE(seen(light, setting).mean, 150) << light;
    }
  }
}

TEST(ExposureRegulation, GainIsUsedOnlyWhereTheExposureIsAtItsLimit) {
  EXPECT_EQ(settled(300, {100, 160}).gain, 0);
  EXPECT_EQ(settled(30, {1, 0}).exposure, range.longest_exposure);
  EXPECT_GT(settled(30, {1, 0}).gain, 0);
}

TEST(ExposureRegulation, InTheDarkAndInTheSunItStopsAtTheLimits) {
  EXPECT_EQ(settled(0, {10, 0}), (ExposureSetting{100, 160}));
  EXPECT_EQ(settled(1e6, {100, 160}), (ExposureSetting{1, 0}));
}

TEST(ExposureRegulation, ASmallExposureStillMoves) {
  const ExposureSetting brighter = nextExposure({1, 0}, range, {70, 0});
  EXPECT_EQ(brighter.exposure, 2);
}

TEST(FrameBrightness, IsTheMeanAndTheShareOfWhite) {
  cv::Mat image(64, 64, CV_8U, cv::Scalar(100));
  EXPECT_EQ(frameBrightness(image).mean, 100);
  EXPECT_EQ(frameBrightness(image).overexposed_share, 0);
  image.rowRange(0, 32).setTo(255);
  EXPECT_NEAR(frameBrightness(image).mean, 177.5, 1e-9);
  EXPECT_EQ(frameBrightness(image).overexposed_share, 0.5);
  EXPECT_EQ(frameBrightness(cv::Mat(1, 1, CV_8U, cv::Scalar(9))).mean, 9);
}

}  // namespace
}  // namespace edgeslam
