#include "frames/image_file.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

cv::Mat ramp() {
  cv::Mat image(48, 64, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) image.at<unsigned char>(y, x) = static_cast<unsigned char>(3 * x + y);
  }
  return image;
}

std::string encoded(const std::string& extension, const cv::Mat& image, const std::vector<int>& options = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, options);
  return {bytes.begin(), bytes.end()};
}

TEST(ImageFile, LosslessImagesAreReadAsTheyAre) {
  const TemporaryFolder folder;
  for (const char* extension : {".png", ".pgm"}) {
    const DecodedImage image =
        readGreyImage(folder.write("image" + std::string(extension), encoded(extension, ramp())));
    ASSERT_EQ(image.problem, "") << extension;
    EXPECT_EQ(cv::norm(image.grey, ramp(), cv::NORM_INF), 0) << extension;
  }
}

TEST(ImageFile, SixteenBitsAreScaledToEight) {
  cv::Mat deep;
  ramp().convertTo(deep, CV_16U, 257);
  const TemporaryFolder folder;
  const DecodedImage image = readGreyImage(folder.write("deep.png", encoded(".png", deep)));
  ASSERT_EQ(image.problem, "");
  EXPECT_EQ(image.grey.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(image.grey, ramp(), cv::NORM_INF), 0);
}

TEST(ImageFile, ColourBecomesGrey) {
  const cv::Mat colour(10, 10, CV_8UC3, cv::Scalar(200, 200, 200));
  const TemporaryFolder folder;
  const DecodedImage image = readGreyImage(folder.write("c.png", encoded(".png", colour)));
  ASSERT_EQ(image.problem, "");
  EXPECT_EQ(cv::norm(image.grey, cv::Mat(10, 10, CV_8UC1, cv::Scalar(200)), cv::NORM_INF), 0);
}

TEST(ImageFile, ATruncatedImageIsAProblemWhereverItIsCut) {
  const TemporaryFolder folder;
  cv::Mat noise(48, 64, CV_8UC1);
  cv::RNG random(1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  const std::vector<std::pair<std::string, std::string>> files{
      {".jpg", encoded(".jpg", noise)},
      {".jpg", encoded(".jpg", noise, {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 2})},
      {".png", encoded(".png", noise)},
      {".pgm", encoded(".pgm", noise)}};
  for (const auto& [extension, bytes] : files) {
    const std::string path = folder.write("whole" + extension, bytes);
    ASSERT_EQ(readGreyImage(path).problem, "") << extension;
    for (const double share : {0.0, 0.001, 0.01, 0.1, 0.5, 0.9, 0.99}) {
      const std::size_t length = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
      const std::string cut = folder.write("cut" + extension, bytes.substr(0, length));
      const DecodedImage image = readGreyImage(cut);
      EXPECT_NE(image.problem.find(cut), std::string::npos) << extension << " cut to " << length;
      EXPECT_TRUE(image.grey.empty());
    }
  }
  const std::string& jpeg = files.front().second;
  EXPECT_NE(readGreyImage(folder.write("one.jpg", jpeg.substr(0, jpeg.size() - 1))).problem, "");
  EXPECT_EQ(readGreyImage(folder.write("padded.jpg", jpeg + std::string(100, '\0'))).problem, "");
}

TEST(ImageFile, WhatIsNoImageIsAProblem) {
  const TemporaryFolder folder;
  EXPECT_NE(readGreyImage(folder.path("missing.png")).problem.find("no such file"), std::string::npos);
  EXPECT_NE(readGreyImage(folder.path()).problem.find("not a file"), std::string::npos);
  EXPECT_NE(readGreyImage(folder.write("text.png", "no image at all")).problem, "");
  EXPECT_NE(readGreyImage(folder.write("huge.pgm", "P5 2000000000 2000000000 255\n")).problem, "");
}

// 20 bytes to 400 that would cost gigabytes and seconds.
TEST(ImageFile, ASmallFileThatClaimsAHugeImageIsRefusedBeforeItIsDecoded) {
  using namespace std::string_literals;
  struct Claim {
    std::string extension, size, huge;
  };
  const TemporaryFolder folder;
  for (const auto& [extension, size, huge] :
       {Claim{".png", "\0\0\0\x40\0\0\0\x30"s, "\0\1\0\0\0\1\0\0"s}, Claim{".jpg", "\0\x30\0\x40"s, "\xFF\0\xFF\0"s},
        Claim{".pgm", "64 48", "60000 60000"}}) {
    std::string bytes = encoded(extension, ramp());
    const std::size_t at = bytes.find(size);
    ASSERT_LT(at, bytes.size()) << extension;
    bytes.replace(at, size.size(), huge);
    const std::string path = folder.write("huge" + extension, bytes);
    EXPECT_EQ(readGreyImage(path).problem, path + ": too large for an image");
  }
}

// Some readers have GDAL open a file with DTED at byte 140, which finds this format and would follow it to other files
// and hosts.
TEST(ImageFile, FormatsThatNameOtherFilesAreNoImages) {
  const TemporaryFolder folder;
  const std::string other = folder.write("other.pgm", "P5 4 4 255\n0123456789abcdef");
  ASSERT_EQ(readGreyImage(other).problem, "");
  std::string pointer = "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><!--";
  pointer.resize(140, ' ');
  pointer += "DTED--><VRTRasterBand dataType=\"Byte\" band=\"1\"><SimpleSource><SourceFilename>" + other +
             "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>\n";
  const DecodedImage image = readGreyImage(folder.write("frame.png", pointer));
  EXPECT_TRUE(image.grey.empty());
  EXPECT_NE(image.problem.find("frame.png: is no PNG, JPEG"), std::string::npos) << image.problem;
}

// A few hundred bytes within the limits that would cost 64 MB and a second.
TEST(ImageFile, AFileThatIsTooSmallForItsSizeIsRefusedBeforeItIsDecoded) {
  using namespace std::string_literals;
  const TemporaryFolder folder;
  std::string png = encoded(".png", ramp()), jpeg = encoded(".jpg", cv::Mat(48, 64, CV_8U, cv::Scalar(90)));
  png.replace(16, 8, "\0\0\x20\0\0\0\x20\0"s);
  jpeg.replace(jpeg.find("\0\x30\0\x40"s), 4, "\x20\0\x20\0"s);
  for (const auto& [name, bytes] : {std::pair("a.png", png), std::pair("b.jpg", jpeg)}) {
    const std::string path = folder.write(name, bytes);
    EXPECT_EQ(readGreyImage(path).problem, path + ": is cut off or damaged: 8192 x 8192 pixels are not in " +
                                               std::to_string(bytes.size()) + " bytes");
  }
}

TEST(ImageFile, AnotherSizeThanExpectedIsToldByTheHeaderAlone) {
  const TemporaryFolder folder;
  const std::string whole = encoded(".png", ramp());
  const ExpectedSize expected{{640, 480}, "camera.yaml says"};
  const std::string path = folder.write("cut.png", whole.substr(0, 60));  // its pixels cannot be decoded
  EXPECT_EQ(readGreyImage(path, expected).problem, path + ": is 64 x 48 pixels, camera.yaml says 640 x 480");
  EXPECT_EQ(readGreyImage(folder.write("whole.png", whole), {{64, 48}, "camera.yaml says"}).problem, "");
}

TEST(ImageFile, OtherFormatsAreNamed) {
  const TemporaryFolder folder;
  for (const auto& [extension, name] :
       {std::pair(".bmp", "BMP"), std::pair(".tiff", "TIFF"), std::pair(".webp", "WebP")}) {
    const std::string path = folder.write("frame" + std::string(extension), encoded(extension, ramp()));
    const std::string problem = readGreyImage(path).problem;
    EXPECT_EQ(problem.find(path + ": is a " + name), 0U) << problem;
    EXPECT_NE(problem.find("; convert it to PNG"), std::string::npos) << problem;
  }
}

TEST(ImageFile, AnotherSizeIsToldWithBoth) {
  EXPECT_EQ(sizeProblem({640, 480}, {640, 480}, "x"), "");
  EXPECT_EQ(sizeProblem({640, 480}, {}, "x"), "");
  EXPECT_EQ(sizeProblem({320, 240}, {640, 480}, "camera.yaml says"), "is 320 x 240 pixels, camera.yaml says 640 x 480");
}

}  // namespace
}  // namespace edgeslam
