// The libcamera driver against the kernel's virtual sensor and scaler (vimc), in a virtual machine: run.sh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <opencv2/core.hpp>

#include "app/cameras_command.h"
#include "app/open_camera.h"
#include "vm/vivid_device.h"

namespace edgeslam {
namespace {

TEST(Libcamera, VimcIsListedAndStreams) {
  if (std::getenv("EDGESLAM_VIMC") == nullptr) GTEST_SKIP() << "no vimc here";
  const LibcameraListing listing = listLibcameras();
  std::cout << "libcamera " << listing.version << "\n" << camerasText({}, listing);
  ASSERT_FALSE(listing.cameras.empty()) << listing.problem;
  for (int round = 0; round < 2; ++round) {  // opened again after it was closed
    CameraOptions options;
    options.device = libcamera_prefix + listing.cameras.back().name;
    options.every_frame = true;
    const OpenedCamera opened = openCamera(options);
    ASSERT_TRUE(opened.camera) << opened.problem;
    std::cout << opened.camera->stream().format << "\n";
    cv::Mat grey;
    std::int64_t last_ns = 0, last_sequence = -1;
    for (int i = 0; i < 10; ++i) {
      const Capture capture = opened.camera->next(grey, std::chrono::seconds(5));
      ASSERT_EQ(capture.event, CaptureEvent::frame) << capture.message;
      EXPECT_GT(capture.frame.time_ns, last_ns);
      EXPECT_GT(capture.frame.sequence, last_sequence);
      EXPECT_EQ(grey.cols, opened.camera->stream().width);
      last_ns = capture.frame.time_ns;
      last_sequence = capture.frame.sequence;
    }
    double least = 0, largest = 0;
    cv::minMaxLoc(grey, &least, &largest);
    EXPECT_GT(largest - least, 100);  // its colour bars
  }
}

TEST(Libcamera, TheCameraTellsWhatItRefuses) {
  if (std::getenv("EDGESLAM_VIMC") == nullptr) GTEST_SKIP() << "no vimc here";
  CameraOptions options;
  options.device = libcamera_prefix + listLibcameras().cameras.back().name;
  options.format = "NV12";
  OpenedCamera opened = openCamera(options);
  EXPECT_FALSE(opened.camera);
  EXPECT_NE(opened.problem.find("has no format NV12; it offers"), std::string::npos) << opened.problem;
  options.format = "";
  options.controls = {{"Brightness", "7"}};
  opened = openCamera(options);
  EXPECT_FALSE(opened.camera);
  std::cout << opened.problem << "\n";
  EXPECT_NE(opened.problem.find("Brightness 7"), std::string::npos) << opened.problem;
}

}  // namespace
}  // namespace edgeslam
