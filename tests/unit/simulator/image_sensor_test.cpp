#include "simulator/image_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

TEST(ImageSensor, NoiseIsAsStated) {
  SensorOptions options;
  options.noise = 4;
  options.vignetting = 0;
  for (const double grey : {30.0, 128.0, 200.0}) {
    const cv::Mat radiance(240, 320, CV_32F, cv::Scalar(grey / 255));
    cv::Scalar mean, deviation;
    cv::meanStdDev(senseImage(radiance, 1, options, 9), mean, deviation);
    EXPECT_NEAR(mean[0], grey, 0.1);
    // Rounding to whole grey values adds a variance of 1/12.
    EXPECT_NEAR(deviation[0], std::sqrt(std::pow(noiseAt(grey, options), 2) + 1.0 / 12), 0.03 * deviation[0]);
  }
  EXPECT_NEAR(noiseAt(128, options), 4, 1e-9);
}

TEST(ImageSensor, SameSeedSameNoise) {
  const cv::Mat radiance(48, 64, CV_32F, cv::Scalar(0.5));
  const cv::Mat first = senseImage(radiance, 1, {}, 1), second = senseImage(radiance, 1, {}, 1),
                other = senseImage(radiance, 1, {}, 2);
  EXPECT_EQ(cv::norm(first, second, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(first, other, cv::NORM_INF), 0);
}

TEST(ImageSensor, WithoutNoiseOnlyGainAndVignettingShow) {
  SensorOptions options;
  options.noise = 0;
  options.vignetting = 0.2;
  const cv::Mat grey = senseImage(cv::Mat(101, 201, CV_32F, cv::Scalar(0.2)), 2, options, 1);
  EXPECT_EQ(grey.at<unsigned char>(50, 100), 102);
  EXPECT_NEAR(grey.at<unsigned char>(0, 0), 0.8 * 102, 1);
  EXPECT_NEAR(grey.at<unsigned char>(100, 200), 0.8 * 102, 1);
}

TEST(ImageSensor, ClipsAtFullScale) {
  const cv::Mat grey = senseImage(cv::Mat(10, 10, CV_32F, cv::Scalar(5)), 1, {}, 1);
  EXPECT_EQ(cv::norm(grey, cv::Mat(10, 10, CV_8U, cv::Scalar(255)), cv::NORM_INF), 0);
}

TEST(AutomaticGains, FollowTheLightSlowly) {
  std::vector<double> means(200, 0.5);
  for (std::size_t i = 50; i < means.size(); ++i) means[i] = 1.0;
  const std::vector<double> gains = automaticGains(means, 1 / 30.0);
  ASSERT_EQ(gains.size(), means.size());
  EXPECT_NEAR(gains[49], 2 * gains.back(), 0.05 * gains[49]);
  EXPECT_GT(gains[52], 0.85 * gains[49]);  // not at once
  for (std::size_t i = 51; i < gains.size(); ++i) EXPECT_LE(gains[i], gains[i - 1]);
}

TEST(AutomaticGains, StayFiniteInTheDark) {
  for (const double gain : automaticGains(std::vector<double>(50, 0.0), 1 / 30.0)) EXPECT_TRUE(std::isfinite(gain));
}

}  // namespace
}  // namespace edgeslam
