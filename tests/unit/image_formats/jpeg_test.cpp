#include "image_formats/jpeg.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <vector>

#include "unit/image_formats/read_by_opencv.h"

namespace edgeslam {
namespace {

// Smooth, as photographs are.
cv::Mat picture(cv::Size size, int type) {
  cv::Mat image(size, type);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {}, 2);
  cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
  return image;
}

std::string encodedJpeg(const cv::Mat& image, const std::vector<int>& options = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, options);
  return {bytes.begin(), bytes.end()};
}

TEST(Jpeg, IsReadAsOpenCvReadsIt) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(33, 17), cv::Size(640, 480)}) {
      for (const std::vector<int>& options : std::vector<std::vector<int>>{{},
                                                                           {cv::IMWRITE_JPEG_QUALITY, 30},
                                                                           {cv::IMWRITE_JPEG_PROGRESSIVE, 1},
                                                                           {cv::IMWRITE_JPEG_RST_INTERVAL, 2}}) {
        const std::string bytes = encodedJpeg(picture(size, type), options);
        const cv::Mat grey = decodeJpeg(bytes), expected = asOpenCvReads(bytes);
        ASSERT_EQ(grey.size(), size);
        EXPECT_EQ(cv::norm(grey, expected, cv::NORM_INF), 0) << size;
      }
    }
  }
}

TEST(Jpeg, IsEncodedAsOpenCvDoes) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const int quality : {30, 70, 82, 100}) {
      const cv::Mat image = picture({65, 49}, type);
      const std::vector<unsigned char> bytes = encodeJpeg(image, quality);
      EXPECT_EQ(std::string(bytes.begin(), bytes.end()), encodedJpeg(image, {cv::IMWRITE_JPEG_QUALITY, quality}))
          << quality;
    }
  }
}

TEST(Jpeg, APartOfAnImageIsEncodedToo) {
  const cv::Mat whole = picture({64, 48}, CV_8U), part = whole(cv::Rect(8, 8, 32, 24));
  EXPECT_EQ(encodeJpeg(part, 80), encodeJpeg(part.clone(), 80));
}

TEST(Jpeg, WhatIsCutOffIsNotWhole) {
  const std::string bytes = encodedJpeg(picture({33, 17}, CV_8UC3));
  EXPECT_TRUE(jpegIsWhole(bytes));
  EXPECT_TRUE(jpegIsWhole(bytes + std::string(100, '\0')));
  for (std::size_t length = 0; length < bytes.size(); ++length) EXPECT_FALSE(jpegIsWhole(bytes.substr(0, length)));
}

TEST(Jpeg, AnyByteChangedIsReadOrNotReadWithoutHarm) {
  const std::string whole = encodedJpeg(picture({33, 17}, CV_8UC3), {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  std::mt19937 random(3);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ static_cast<char>(1 + random() % 255));
    const cv::Mat image = decodeJpeg(bytes);
    EXPECT_TRUE(image.empty() || image.type() == CV_8U) << i;
  }
}

// Each scan goes over the whole image, however few bytes it has.
TEST(Jpeg, AnImageOfEndlessScansIsNotDecoded) {
  std::string bytes = encodedJpeg(picture({64, 48}, CV_8U), {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  const std::string scan = bytes.substr(bytes.rfind("\xFF\xDA"));
  ASSERT_FALSE(decodeJpeg(bytes).empty());
  bytes.resize(bytes.size() - 2);
  for (int i = 0; i < 100; ++i) bytes += scan.substr(0, scan.size() - 2);
  EXPECT_TRUE(decodeJpeg(bytes + "\xFF\xD9").empty());
}

}  // namespace
}  // namespace edgeslam
