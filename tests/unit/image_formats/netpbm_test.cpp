#include "image_formats/netpbm.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace edgeslam {
namespace {

using namespace std::string_literals;

TEST(Netpbm, IsReadAsOpenCvReadsIt) {
  for (const auto& [extension, type] : {std::pair(".pgm", CV_8UC1), std::pair(".ppm", CV_8UC3)}) {
    cv::Mat image(17, 33, type);
    cv::RNG random(1);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    std::vector<unsigned char> bytes;
    cv::imencode(extension, image, bytes);
    const cv::Mat grey = decodeNetpbm({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    ASSERT_EQ(grey.size(), image.size()) << extension;
    EXPECT_EQ(cv::norm(grey, cv::imdecode(bytes, cv::IMREAD_GRAYSCALE), cv::NORM_INF), 0) << extension;
  }
}

TEST(Netpbm, WhatWasEncodedIsReadBackHereAndByOpenCv) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(33, 17), cv::Size(640, 480)}) {
    cv::Mat wide(size.height, size.width + 5, CV_8U);
    cv::RNG(3).fill(wide, cv::RNG::UNIFORM, 0, 256);
    const cv::Mat image = wide.colRange(2, 2 + size.width);  // rows with others between them
    const std::vector<unsigned char> bytes = encodePgm(image);
    EXPECT_LT(bytes.size(), image.total() + 20);
    const cv::Mat read = decodeNetpbm({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    ASSERT_EQ(read.size(), size);
    EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(cv::imdecode(bytes, cv::IMREAD_UNCHANGED), image, cv::NORM_INF), 0);
  }
}

TEST(Netpbm, OtherRangesAreScaled) {
  EXPECT_EQ(decodeNetpbm("P5 3 1 65535\n\x00\x00\x80\x80\xFF\xFF"s).at<unsigned char>(0, 1), 128);
  const cv::Mat few = decodeNetpbm("P5 # of three\n 3 1\n 2\n\x00\x01\x02"s);
  ASSERT_EQ(few.size(), cv::Size(3, 1));
  EXPECT_EQ(few.at<unsigned char>(0, 0), 0);
  EXPECT_EQ(few.at<unsigned char>(0, 1), 128);
  EXPECT_EQ(few.at<unsigned char>(0, 2), 255);
  EXPECT_EQ(decodeNetpbm("P5 1 1 2\n\xFF"s).at<unsigned char>(0, 0), 255);  // beyond its own range
}

TEST(Netpbm, WhatIsNotWholeIsNotRead) {
  for (const std::string& bytes :
       {"P5"s, "P5 2 2 255"s, "P5 2 2 255\n123"s, "P6 2 2 255\n12345678901"s, "P5 2 2 65535\n1234567"s, "P5 0 2 255\n"s,
        "P5 2 0 255\n"s, "P5 2 2 0\n1234"s, "P5 2 2 65536\n12345678"s, "P5 -2 2 255\n1234"s, "P5 2 x 255\n1234"s,
        "P5 99999999999999999999 1 255\n1234"s, "P5 60000 60000 255\n1234"s}) {
    EXPECT_TRUE(decodeNetpbm(bytes).empty()) << bytes;
  }
}

}  // namespace
}  // namespace edgeslam
