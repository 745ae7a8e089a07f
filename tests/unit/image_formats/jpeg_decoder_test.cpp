#include "image_formats/jpeg_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "unit/image_formats/made_jpeg.h"

namespace edgeslam {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat colourfulImage(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto wave = [&](int a, int b) {
        return static_cast<std::uint8_t>(128 + 100 * std::sin(0.05 * (a * x + b * y)));
      };
      image.at<cv::Vec3b>(y, x) = {wave(1, 2), wave(3, -1), wave(-2, 1)};
    }
  }
  return image;
}

Bytes jpegOf(const cv::Mat& image) {
  Bytes bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 90});
  return bytes;
}

std::string decode(const Bytes& bytes, cv::Size size, cv::Mat& grey) {
  JpegDecoder decoder;
  const Bytes exact(bytes);  // no spare capacity behind it
  grey.create(size, CV_8U);
  return decoder.decode(exact.data(), exact.size(), grey);
}

TEST(JpegDecoder, GivesTheBrightnessOfColouredAndOfGreyImages) {
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(35, 21), cv::Size(1, 1)}) {
    const cv::Mat image = colourfulImage(size);
    cv::Mat expected, grey;
    cv::cvtColor(image, expected, cv::COLOR_BGR2GRAY);
    EXPECT_EQ(decode(jpegOf(image), size, grey), "");
    EXPECT_LT(cv::norm(grey, expected, cv::NORM_L1) / size.area(), 4);
    EXPECT_EQ(decode(jpegOf(expected), size, grey), "");
    EXPECT_LT(cv::norm(grey, expected, cv::NORM_L1) / size.area(), 4);
  }
}

TEST(JpegDecoder, FramesWithoutHuffmanTablesAreTheSame) {
  const Bytes whole = jpegOf(colourfulImage({64, 48}));
  const Bytes bare = withoutHuffmanTables(whole);
  ASSERT_LT(bare.size() + 400, whole.size());
  cv::Mat expected, grey;
  EXPECT_EQ(decode(whole, {64, 48}, expected), "");
  EXPECT_EQ(decode(bare, {64, 48}, grey), "");
  EXPECT_EQ(cv::norm(grey, expected, cv::NORM_INF), 0);
}

TEST(JpegDecoder, PaddingAroundTheEndIsHarmless) {
  const Bytes whole = jpegOf(colourfulImage({64, 48}));
  cv::Mat expected, grey;
  EXPECT_EQ(decode(whole, {64, 48}, expected), "");
  Bytes after = whole, before = whole;
  after.insert(after.end(), 500, 0);
  before.insert(before.end() - 2, 5, 0);
  EXPECT_EQ(decode(after, {64, 48}, grey), "");
  EXPECT_EQ(cv::norm(grey, expected, cv::NORM_INF), 0);
  EXPECT_EQ(decode(before, {64, 48}, grey), "");
  EXPECT_EQ(cv::norm(grey, expected, cv::NORM_INF), 0);
}

// A frame that was cut off anywhere is told, whatever the decoder would make of it.
TEST(JpegDecoder, EveryCutIsAnError) {
  const Bytes whole = jpegOf(colourfulImage({64, 48}));
  for (std::size_t size = 0; size < whole.size(); size += size < 700 ? 1 : 13) {
    cv::Mat grey;
    EXPECT_NE(decode(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), {64, 48}, grey), "")
        << size;
  }
}

// By the same decoder, as a camera's is.
TEST(JpegDecoder, ACutFrameHarmsNoneAfterIt) {
  const Bytes whole = jpegOf(colourfulImage({64, 48}));
  JpegDecoder decoder;
  cv::Mat expected(48, 64, CV_8U), grey(48, 64, CV_8U);
  ASSERT_EQ(decoder.decode(whole.data(), whole.size(), expected), "");
  for (std::size_t size = 0; size < whole.size(); size += size < 700 ? 1 : 13) {
    EXPECT_NE(
        decoder.decode(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)).data(), size, grey), "");
    ASSERT_EQ(decoder.decode(whole.data(), whole.size(), grey), "") << "after one of " << size << " bytes";
    ASSERT_EQ(cv::norm(grey, expected, cv::NORM_INF), 0) << size;
  }
}

TEST(JpegDecoder, DamagedBytesNeverCrashAndMostlyAreTold) {
  const Bytes whole = jpegOf(colourfulImage({64, 48}));
  cv::RNG random(5);
  int told = 0;
  for (int i = 0; i < 2000; ++i) {
    Bytes damaged = whole;
    for (int k = 0; k < 8; ++k) {
      damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random.uniform(0, 256));
    }
    cv::Mat grey;
    told += decode(damaged, {64, 48}, grey).empty() ? 0 : 1;
  }
  EXPECT_GT(told, 1000);
}

TEST(JpegDecoder, AnotherSizeIsAnError) {
  cv::Mat grey;
  const std::string problem = decode(jpegOf(colourfulImage({64, 48})), {48, 64}, grey);
  EXPECT_NE(problem.find("64 x 48"), std::string::npos) << problem;
  EXPECT_NE(problem.find("expected 48 x 64"), std::string::npos) << problem;
}

TEST(JpegDecoder, WhatIsNoJpegIsAnError) {
  cv::Mat grey;
  for (const Bytes& bytes : {Bytes(), Bytes{0xFF}, Bytes(3000, 0xFF), Bytes(3000, 0), Bytes{0xFF, 0xD8, 0xFF, 0xD9}}) {
    EXPECT_NE(decode(bytes, {64, 48}, grey), "");
  }
}

}  // namespace
}  // namespace edgeslam
