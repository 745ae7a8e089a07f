#include "frames/image_header.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace edgeslam {
namespace {

struct Encoding {
  std::string name, extension;
  std::vector<int> options;
  int type = CV_8UC1;
};

std::string encoded(const Encoding& encoding, cv::Size size) {
  std::vector<unsigned char> bytes;
  cv::imencode(encoding.extension, cv::Mat(size, encoding.type, cv::Scalar::all(90)), bytes, encoding.options);
  return {bytes.begin(), bytes.end()};
}

class ImageHeader : public testing::TestWithParam<Encoding> {};

TEST_P(ImageHeader, TellsTheSizeOfWhatWasEncoded) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 480), cv::Size(3, 300), cv::Size(1025, 17)}) {
    const auto claimed = claimedSize(encoded(GetParam(), size));
    ASSERT_TRUE(claimed) << size;
    EXPECT_EQ(claimed->width, size.width);
    EXPECT_EQ(claimed->height, size.height);
  }
}

TEST_P(ImageHeader, CutAnywhereTellsThatSizeOrNone) {
  const cv::Size size(40, 30);
  const std::string whole = encoded(GetParam(), size);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto claimed = claimedSize(whole.substr(0, length));
    if (!claimed || GetParam().extension == ".pgm" || GetParam().extension == ".ppm") continue;  // digits may be cut
    EXPECT_EQ(claimed->width, size.width) << length;
    EXPECT_EQ(claimed->height, size.height) << length;
  }
  EXPECT_FALSE(claimedSize(whole.substr(0, 3)));
}

INSTANTIATE_TEST_SUITE_P(Formats, ImageHeader,
                         testing::Values(Encoding{"png", ".png", {}}, Encoding{"png_colour", ".png", {}, CV_8UC3},
                                         Encoding{"png_deep", ".png", {}, CV_16UC1}, Encoding{"jpeg", ".jpg", {}},
                                         Encoding{"jpeg_progressive", ".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1}},
                                         Encoding{"bmp", ".bmp", {}}, Encoding{"pgm", ".pgm", {}},
                                         Encoding{"pgm_text", ".pgm", {cv::IMWRITE_PXM_BINARY, 0}},
                                         Encoding{"ppm", ".ppm", {}, CV_8UC3}, Encoding{"tiff", ".tiff", {}},
                                         Encoding{"webp_lossy", ".webp", {cv::IMWRITE_WEBP_QUALITY, 50}},
                                         Encoding{"webp_lossless", ".webp", {cv::IMWRITE_WEBP_QUALITY, 101}}),
                         [](const auto& encoding) { return encoding.param.name; });

TEST(ImageHeader, OtherWritersSizesAreToldToo) {
  using namespace std::string_literals;
  struct Example {
    std::string bytes;
    std::int64_t width, height;
  };
  for (const auto& [bytes, width, height] :
       {Example{"P5\n# 7 7\n 640\t480 255\n", 640, 480}, Example{"P2 99999999999999999999 2 255\n", 1'000'000'000, 2},
        Example{"BM" + std::string(12, '\0') + "\x0C\0\0\0\x40\1\xF0\0"s, 320, 240},
        // Most significant byte first; a tile that is wider than the image.
        Example{"MM\0*\0\0\0\x08\0\3"s + "\1\0\0\3\0\0\0\1\0\x10\0\0"s + "\1\1\0\4\0\0\0\1\0\0\0\x20"s +
                    "\1\x42\0\4\0\0\0\1\0\1\0\0"s,
                65536, 32},
        Example{"RIFF\0\0\0\0WEBPVP8X\x0A\0\0\0\0\0\0\0\xFF\xFF\0\x0F\0\0"s, 65536, 16}}) {
    const auto claimed = claimedSize(bytes);
    ASSERT_TRUE(claimed) << bytes;
    EXPECT_EQ(claimed->width, width);
    EXPECT_EQ(claimed->height, height);
  }
}

TEST(ImageHeader, WhatHasNoSizeHasNone) {
  using namespace std::string_literals;
  for (const std::string& bytes :
       {""s, "P"s, "P5 640"s, "P7 640 480 255"s, "II*\0\xFF\xFF\xFF\xFF"s, "II*\0\x08\0\0\0\0\0"s, "\xFF\xD8\xFF"s,
        "\xFF\xD8\xFF\xE0\0\x02\xFF\xD9"s, "RIFF\0\0\0\0WEBP"s, "RIFF\0\0\0\0WEBPVP8?"s, "text"s}) {
    EXPECT_FALSE(claimedSize(bytes)) << bytes;
  }
}

}  // namespace
}  // namespace edgeslam
