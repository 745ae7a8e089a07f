#include "image_formats/png.h"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

#include "unit/image_formats/read_by_opencv.h"

namespace edgeslam {
namespace {

cv::Mat noise(cv::Size size, int type, int seed = 1) {
  cv::Mat image(size, type);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(image, cv::RNG::UNIFORM, 0, image.depth() == CV_16U ? 65536 : 256);
  return image;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.type() == b.type() && a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

void appendBytes(png_structp png, png_bytep bytes, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
}

struct Kind {
  std::string name;
  int colour, bits;
  bool interlaced = false, transparent = false;
  double gamma = 0;  // 0: none is written
};

// Random values in a PNG of any kind, which OpenCV does not write.
std::string written(const Kind& kind, cv::Size size) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, appendBytes, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height), kind.bits,
               kind.colour, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::mt19937 random(7);
  const auto value = [&] { return static_cast<png_byte>(random() & 255U); };
  std::vector<png_color> palette(std::size_t{1} << std::min(kind.bits, 8));
  for (png_color& colour : palette) colour = {value(), value(), value()};
  if (kind.colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_byte alpha[2] = {10, 200};
  png_color_16 one{1, 3, 5, 7, 9};
  if (kind.transparent) png_set_tRNS(png, info, alpha, 2, &one);
  if (kind.gamma > 0) png_set_gAMA(png, info, kind.gamma);
  png_write_info(png, info);
  std::vector<std::vector<png_byte>> rows(static_cast<std::size_t>(size.height),
                                          std::vector<png_byte>(png_get_rowbytes(png, info)));
  std::vector<png_bytep> pointers;
  for (auto& row : rows) {
    for (png_byte& byte : row) byte = value();
    pointers.push_back(row.data());
  }
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string text(const std::vector<unsigned char>& bytes) { return {bytes.begin(), bytes.end()}; }

class PngOfKind : public testing::TestWithParam<Kind> {};

TEST_P(PngOfKind, IsReadAsOpenCvReadsIt) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(33, 17), cv::Size(64, 48)}) {
    const std::string bytes = written(GetParam(), size);
    const cv::Mat expected = asOpenCvReads(bytes);
    ASSERT_FALSE(expected.empty());
    EXPECT_TRUE(same(decodePng(bytes), expected)) << size;
  }
}

TEST_P(PngOfKind, CutOffIsNotRead) {
  const std::string bytes = written(GetParam(), {33, 17});
  for (std::size_t length = 0; length < bytes.size() - 12; length += 7) {  // 12: the mark of the end
    EXPECT_TRUE(decodePng(bytes.substr(0, length)).empty()) << length;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, PngOfKind,
    testing::Values(Kind{"grey_1", PNG_COLOR_TYPE_GRAY, 1}, Kind{"grey_2", PNG_COLOR_TYPE_GRAY, 2},
                    Kind{"grey_4", PNG_COLOR_TYPE_GRAY, 4}, Kind{"grey_8", PNG_COLOR_TYPE_GRAY, 8},
                    Kind{"grey_16", PNG_COLOR_TYPE_GRAY, 16},
                    Kind{"grey_transparent", PNG_COLOR_TYPE_GRAY, 8, false, true},
                    Kind{"grey_alpha_8", PNG_COLOR_TYPE_GRAY_ALPHA, 8},
                    Kind{"grey_alpha_16", PNG_COLOR_TYPE_GRAY_ALPHA, 16}, Kind{"rgb_8", PNG_COLOR_TYPE_RGB, 8},
                    Kind{"rgb_16", PNG_COLOR_TYPE_RGB, 16}, Kind{"rgb_transparent", PNG_COLOR_TYPE_RGB, 8, false, true},
                    Kind{"rgba_8", PNG_COLOR_TYPE_RGB_ALPHA, 8}, Kind{"rgba_16", PNG_COLOR_TYPE_RGB_ALPHA, 16},
                    Kind{"palette_1", PNG_COLOR_TYPE_PALETTE, 1}, Kind{"palette_2", PNG_COLOR_TYPE_PALETTE, 2},
                    Kind{"palette_4", PNG_COLOR_TYPE_PALETTE, 4}, Kind{"palette_8", PNG_COLOR_TYPE_PALETTE, 8},
                    Kind{"palette_transparent", PNG_COLOR_TYPE_PALETTE, 8, false, true},
                    Kind{"grey_interlaced", PNG_COLOR_TYPE_GRAY, 8, true},
                    Kind{"rgb_interlaced", PNG_COLOR_TYPE_RGB, 8, true},
                    Kind{"rgb_gamma", PNG_COLOR_TYPE_RGB, 8, false, false, 0.45455},
                    Kind{"rgb_16_gamma", PNG_COLOR_TYPE_RGB, 16, false, false, 0.45455}),
    [](const auto& kind) { return kind.param.name; });

TEST(Png, WhatWasEncodedIsReadBack) {
  for (const PngEffort effort : {PngEffort::huffman, PngEffort::quick, PngEffort::small}) {
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(33, 17), cv::Size(640, 480)}) {
      const cv::Mat image = noise(size, CV_8U);
      EXPECT_TRUE(same(decodePng(text(encodePng(image, effort))), image)) << size;
    }
  }
}

// Files that were written before have the same bytes as those written now.
TEST(Png, IsEncodedAsOpenCvDoes) {
  const std::vector<std::pair<PngEffort, std::vector<int>>> efforts{
      {PngEffort::quick, {}},
      {PngEffort::small, {cv::IMWRITE_PNG_COMPRESSION, 1}},
      {PngEffort::huffman, {cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY}}};
  for (const auto& [effort, options] : efforts) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      cv::Mat image = noise({64, 48}, type);
      image.rowRange(10, 30).setTo(cv::Scalar(20, 90, 200));
      std::vector<unsigned char> expected;
      cv::imencode(".png", image, expected, options);
      EXPECT_EQ(encodePng(image, effort), expected) << type;
    }
  }
}

TEST(Png, AnyByteChangedIsReadOrNotReadWithoutHarm) {
  const std::string whole = text(encodePng(noise({33, 17}, CV_8UC3)));
  std::mt19937 random(3);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ static_cast<char>(1 + random() % 255));
    const cv::Mat image = decodePng(bytes);
    EXPECT_TRUE(image.empty() || image.size() == cv::Size(33, 17)) << i;
  }
}

std::string chunk(const std::string& name, const std::string& content) {
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
      bytes += static_cast<char>(value >> static_cast<unsigned>(shift) & 255U);
    return bytes;
  };
  const std::string checked = name + content;
  const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size());
  return number(static_cast<std::uint32_t>(content.size())) + checked + number(static_cast<std::uint32_t>(sum));
}

// 60 chunks of text that a few KB each inflate to 8 MB would take 480 MB.
TEST(Png, PackedTextBesideTheImageIsNotUnpacked) {
  std::string packed(1 << 16, '\0');
  const std::string content(8'000'000, 'x');
  uLongf size = packed.size();
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(content.data()),
                     content.size()),
            Z_OK);
  packed.resize(size);
  const cv::Mat image = noise({20, 10}, CV_8U);
  std::string bytes = text(encodePng(image));
  for (int i = 0; i < 60; ++i) bytes.insert(33, chunk("zTXt", std::string("comment\0\0", 9) + packed));
  EXPECT_TRUE(same(decodePng(bytes), image));
}

}  // namespace
}  // namespace edgeslam
