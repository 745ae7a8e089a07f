#include "map/packed_image.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stdexcept>

#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

bool areSame(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

cv::Mat slopes(int width, int height) {
  cv::Mat image(height, width, CV_8U);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at<unsigned char>(y, x) = static_cast<unsigned char>(x / 3 + y / 2);
  }
  return image;
}

TEST(PackedImage, GivesEveryPixelBack) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 1), cv::Size(1, 9), cv::Size(31, 17), cv::Size(640, 480)}) {
    const cv::Mat noise = test::noiseImage(size.width, size.height, size.area());
    EXPECT_TRUE(areSame(unpacked(packed(noise)), noise)) << size;
    EXPECT_TRUE(areSame(unpacked(packed(slopes(size.width, size.height))), slopes(size.width, size.height))) << size;
  }
}

TEST(PackedImage, GivesAPartOfALargerImageBack) {
  const cv::Mat part = test::noiseImage(64, 48, 5)(cv::Rect(3, 5, 40, 30));
  EXPECT_TRUE(areSame(unpacked(packed(part)), part));
}

TEST(PackedImage, TakesLittleMemoryWhereTheImageIsSmooth) {
  EXPECT_LT(packed(slopes(640, 480)).bytes.capacity(), 640U * 480 / 20);
}

TEST(PackedImage, RefusesWhatIsNone) {
  PackedImage image = packed(slopes(64, 48));
  image.size = {64, 49};
  EXPECT_THROW(unpacked(image), std::logic_error);
  image = packed(slopes(64, 48));
  image.bytes.resize(image.bytes.size() / 2);
  EXPECT_THROW(unpacked(image), std::logic_error);
}

}  // namespace
}  // namespace edgeslam
