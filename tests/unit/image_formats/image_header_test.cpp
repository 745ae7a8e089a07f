#include "image_formats/image_header.h"

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
                                         Encoding{"pgm", ".pgm", {}}, Encoding{"ppm", ".ppm", {}, CV_8UC3}),
                         [](const auto& encoding) { return encoding.param.name; });

TEST_P(ImageHeader, WhatWasEncodedCanHoldItsSize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 480), cv::Size(3, 300), cv::Size(4000, 3000)}) {
    EXPECT_TRUE(canHoldItsSize(encoded(GetParam(), size))) << size;  // of one colour: nothing is smaller
  }
}

TEST(ImageHeader, OtherWritersSizesAreToldToo) {
  const auto claimed = claimedSize("P5\n# 7 7\n 640\t480 255\n");
  ASSERT_TRUE(claimed);
  EXPECT_EQ(claimed->width, 640);
  EXPECT_EQ(claimed->height, 480);
  const auto huge = claimedSize("P6 99999999999999999999 2 255\n");
  ASSERT_TRUE(huge);
  EXPECT_EQ(huge->width, 1'000'000'000);
}

TEST(ImageHeader, WhatHasNoSizeHasNone) {
  using namespace std::string_literals;
  for (const std::string& bytes : {""s, "P"s, "P5 640"s, "P7 640 480 255"s, "\xFF\xD8\xFF"s,
                                   "\xFF\xD8\xFF\xE0\0\x02\xFF\xD9"s, "\x89PNG\r\n\x1a\n"s, "text"s}) {
    EXPECT_FALSE(claimedSize(bytes)) << bytes;
    EXPECT_FALSE(canHoldItsSize(bytes)) << bytes;
  }
}

TEST(ImageHeader, OtherFormatsHaveNames) {
  for (const auto& [extension, name] :
       {std::pair(".bmp", "BMP"), std::pair(".tiff", "TIFF"), std::pair(".webp", "WebP"), std::pair(".pbm", "PBM")}) {
    const std::string bytes = encoded({"", extension, {}}, {40, 30});
    EXPECT_FALSE(imageFormat(bytes)) << extension;
    EXPECT_NE(otherImageFormat(bytes).find(name), std::string::npos) << extension;
  }
  EXPECT_EQ(otherImageFormat("text"), "");
  EXPECT_EQ(otherImageFormat(encoded({"", ".png", {}}, {40, 30})), "");
}

}  // namespace
}  // namespace edgeslam
