#include "frames/mask_file.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "edgeslam/input_error.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

std::string pgm(int width, int height, const std::string& pixels) {
  return "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" + pixels;
}

// Black on its left half.
std::string halfBlack() {
  std::string pixels;
  for (int y = 0; y < 48; ++y) pixels += std::string(32, '\0') + std::string(32, '\xff');
  return pgm(64, 48, pixels);
}

void expectMaskRefused(const std::string& path, const std::string& part) {
  try {
    readMask(path);
    ADD_FAILURE() << "not refused: " << path;
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path + ": ", 0), 0U) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(MaskFile, IsWrittenAsItIsRead) {
  const TemporaryFolder folder;
  const auto mask = readMask(folder.write("mask.pgm", halfBlack()));
  EXPECT_DOUBLE_EQ(maskedShare(*mask), 0.5);
  const auto again = readMask(folder.write("mask.png", encodeMask(*mask)));
  EXPECT_EQ(cv::norm(mask->masked, again->masked, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(mask->hidden, again->hidden, cv::NORM_INF), 0);
}

TEST(MaskFile, WhatIsNoMaskIsRefused) {
  const TemporaryFolder folder;
  expectMaskRefused(folder.path("none.png"), "no such file; expected an image of the camera's size, black where");
  expectMaskRefused(folder.write("text.png", "black"), "is no PNG, JPEG");
  expectMaskRefused(folder.write("cut.pgm", halfBlack().substr(0, 100)), "is cut off or damaged");
  expectMaskRefused(folder.write("black.pgm", pgm(64, 48, std::string(64 * 48, '\0'))), "all of it is black");
}

TEST(MaskFile, HasTheCamerasSize) {
  const TemporaryFolder folder;
  const auto mask = readMask(folder.write("mask.pgm", halfBlack()));
  EXPECT_EQ(maskSizeProblem(*mask, {CameraModel::pinhole_radial_tangential, 64, 48, 50, 50, 32, 24, {}}), "");
  EXPECT_EQ(maskSizeProblem(*mask, {CameraModel::pinhole_radial_tangential, 640, 480, 500, 500, 320, 240, {}}),
            "is 64 x 48 pixels, expected the camera's size, 640 x 480");
}

}  // namespace
}  // namespace edgeslam
