#include "drivers/frame_capture/grey_conversion.h"

#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <vector>

namespace edgeslam {
namespace {

using Bytes = std::vector<std::uint8_t>;

int pattern(int x, int y) { return (x * 7 + y * 13 + x * y) % 256; }

// Brightness of the pixel as the format's bytes; everything that is not brightness is 0xAA.
Bytes encoded(PixelFormat format, int width, int height, std::size_t stride) {
  Bytes bytes(stride * static_cast<std::size_t>(height), 0xAA);
  for (int y = 0; y < height; ++y) {
    std::uint8_t* const row = bytes.data() + stride * static_cast<std::size_t>(y);
    for (int x = 0; x < width; ++x) {
      const int value = pattern(x, y);
      const auto put = [&](int at, int byte) { row[at] = static_cast<std::uint8_t>(byte); };
      const auto put16 = [&](int sample) {
        put(2 * x, sample & 255);
        put(2 * x + 1, sample >> 8);
      };
      switch (format) {
        case PixelFormat::y10:
          put16(value << 2 | 3);
          break;
        case PixelFormat::y12:
          put16(value << 4 | 15);
          break;
        case PixelFormat::y16:
          put16(value << 8 | 255);
          break;
        case PixelFormat::yuyv:
          put(2 * x, value);
          break;
        case PixelFormat::uyvy:
          put(2 * x + 1, value);
          break;
        case PixelFormat::rgb24:
        case PixelFormat::bgr24:
          for (int i = 0; i < 3; ++i) put(3 * x + i, value);
          break;
        default:
          put(x, value);
      }
    }
  }
  return bytes;
}

void expectPattern(const cv::Mat& grey, int width, int height) {
  ASSERT_EQ(grey.size(), cv::Size(width, height));
  ASSERT_EQ(grey.type(), CV_8U);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) ASSERT_EQ(grey.at<std::uint8_t>(y, x), pattern(x, y)) << x << " " << y;
  }
}

class EachFormat : public testing::TestWithParam<PixelFormat> {};

// Exact to the byte, for odd sizes, padded rows, and buffers that end with the last row's brightness.
TEST_P(EachFormat, TheBrightnessIsTaken) {
  JpegDecoder jpeg;
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(33, 7), cv::Size(1, 1), cv::Size(2, 9), cv::Size(641, 3)}) {
    const std::size_t row = rowBytes(GetParam(), size.width);
    for (const std::size_t padding : {std::size_t{0}, std::size_t{1}, std::size_t{30}}) {
      Bytes bytes = encoded(GetParam(), size.width, size.height, row + padding);
      bytes.resize(bytes.size() - padding);
      bytes.shrink_to_fit();  // for the address sanitizer
      cv::Mat grey;
      const BufferLayout layout{GetParam(), size.width, size.height, padding == 0 ? 0 : row + padding};
      EXPECT_EQ(convertToGrey(layout, bytes.data(), bytes.size(), jpeg, grey), "");
      expectPattern(grey, size.width, size.height);
    }
  }
}

TEST_P(EachFormat, ABufferOneByteShortIsRefused) {
  JpegDecoder jpeg;
  const std::size_t stride = rowBytes(GetParam(), 32) + 8;
  const Bytes bytes = encoded(GetParam(), 32, 20, stride);
  cv::Mat grey;
  const BufferLayout layout{GetParam(), 32, 20, stride};
  EXPECT_EQ(convertToGrey(layout, bytes.data(), bytes.size() - 8, jpeg, grey), "");
  for (const std::size_t size : {bytes.size() - 9, stride, std::size_t{1}, std::size_t{0}}) {
    EXPECT_NE(convertToGrey(layout, bytes.data(), size, jpeg, grey).find("cut off"), std::string::npos) << size;
  }
}

TEST_P(EachFormat, ImpossibleLayoutsAreRefused) {
  JpegDecoder jpeg;
  const Bytes bytes(1000, 0);
  cv::Mat grey;
  const std::size_t row = rowBytes(GetParam(), 10);
  for (const BufferLayout& layout : {BufferLayout{GetParam(), 0, 10, 0}, BufferLayout{GetParam(), 10, -1, 0},
                                     BufferLayout{GetParam(), 1 << 20, 1, 0}, BufferLayout{GetParam(), 10, 10, row - 1},
                                     BufferLayout{GetParam(), 10, 10, SIZE_MAX / 4}}) {
    EXPECT_NE(convertToGrey(layout, bytes.data(), bytes.size(), jpeg, grey), "");
  }
}

// The caller's memory is written, whatever lies around it.
TEST_P(EachFormat, WritesIntoTheCallersMemoryAndNothingBeside) {
  JpegDecoder jpeg;
  const Bytes bytes = encoded(GetParam(), 20, 10, rowBytes(GetParam(), 20));
  cv::Mat around(14, 24, CV_8U, cv::Scalar(77));
  cv::Mat inside = around(cv::Rect(2, 2, 20, 10));
  const std::uint8_t* const memory = inside.data;
  EXPECT_EQ(convertToGrey({GetParam(), 20, 10, 0}, bytes.data(), bytes.size(), jpeg, inside), "");
  EXPECT_EQ(inside.data, memory);
  expectPattern(inside, 20, 10);
  inside.setTo(77);
  EXPECT_EQ(cv::countNonZero(around != 77), 0);
}

INSTANTIATE_TEST_SUITE_P(GreyConversion, EachFormat,
                         testing::Values(PixelFormat::grey, PixelFormat::y10, PixelFormat::y12, PixelFormat::y16,
                                         PixelFormat::nv12, PixelFormat::nv21, PixelFormat::yu12, PixelFormat::yuyv,
                                         PixelFormat::uyvy, PixelFormat::rgb24, PixelFormat::bgr24),
                         [](const auto& tested) { return std::string(pixelFormatName(tested.param)); });

TEST(GreyConversion, SamplesBeyondTheirRangeAreWhite) {
  JpegDecoder jpeg;
  const Bytes bytes{0xFF, 0xFF, 0x00, 0x04};
  cv::Mat grey;
  for (const PixelFormat format : {PixelFormat::y10}) {
    EXPECT_EQ(convertToGrey({format, 2, 1, 0}, bytes.data(), bytes.size(), jpeg, grey), "");
    EXPECT_EQ(grey.at<std::uint8_t>(0, 0), 255);
    EXPECT_EQ(grey.at<std::uint8_t>(0, 1), 255);
  }
}

TEST(GreyConversion, ColoursWeighAsInBt601) {
  JpegDecoder jpeg;
  const Bytes red{255, 0, 0}, blue{0, 0, 255}, green{0, 255, 0};
  cv::Mat grey;
  const auto value = [&](PixelFormat format, const Bytes& bytes) {
    EXPECT_EQ(convertToGrey({format, 1, 1, 0}, bytes.data(), bytes.size(), jpeg, grey), "");
    return static_cast<int>(grey.at<std::uint8_t>(0, 0));
  };
  EXPECT_EQ(value(PixelFormat::rgb24, red), 76);
  EXPECT_EQ(value(PixelFormat::rgb24, blue), 29);
  EXPECT_EQ(value(PixelFormat::bgr24, red), 29);
  EXPECT_EQ(value(PixelFormat::bgr24, blue), 76);
  EXPECT_EQ(value(PixelFormat::bgr24, green), 150);
}

TEST(PixelFormats, NamesAndCodesGoThereAndBack) {
  std::set<std::uint32_t> codes;
  for (const PixelFormat format : pixel_formats) {
    EXPECT_EQ(pixelFormatOfName(pixelFormatName(format)), format);
    EXPECT_EQ(pixelFormatOfCode(fourCharacterCode(format)), format);
    codes.insert(fourCharacterCode(format));
  }
  EXPECT_EQ(codes.size(), std::size(pixel_formats));
  EXPECT_FALSE(pixelFormatOfName("grey"));
  EXPECT_FALSE(pixelFormatOfCode(0));
}

}  // namespace
}  // namespace edgeslam
