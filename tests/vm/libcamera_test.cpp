// The libcamera driver, in a virtual machine (run.sh): libcamera 0.0.3 with the kernel's virtual sensor and scaler
// (vimc), and 0.4.0 with its own virtual pipeline. Includes the driver alone, so that it builds where the rest does
// not.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <opencv2/core.hpp>

#include "drivers/libcamera/libcamera_camera.h"

namespace edgeslam {
namespace {

TEST(Libcamera, EveryCameraIsListedAndStreams) {
  if (std::getenv("EDGESLAM_LIBCAMERA") == nullptr) GTEST_SKIP() << "no libcamera camera here";
  const LibcameraListing listing = listLibcameras();
  ASSERT_FALSE(listing.cameras.empty()) << listing.problem;
  for (std::size_t i = 0; i < 2 * listing.cameras.size(); ++i) {  // each opened again after it was closed
    const ListedLibcamera& camera = listing.cameras[i / 2];
    EXPECT_FALSE(camera.formats.empty());
    CameraOptions options;
    options.device = libcamera_prefix + camera.name;
    options.every_frame = true;
    const OpenedCamera opened = openLibcameraCamera(options);
    ASSERT_TRUE(opened.camera) << opened.problem;
    std::cout << "libcamera " << listing.version << ", " << camera.name << ": " << opened.camera->stream().format;
    cv::Mat grey;
    std::int64_t first_ns = 0, last_ns = 0, last_sequence = -1, lost = 0;
    for (int k = 0; k < 15; ++k) {
      const Capture capture = opened.camera->next(grey, std::chrono::seconds(5));
      ASSERT_EQ(capture.event, CaptureEvent::frame) << capture.message;
      EXPECT_GT(capture.frame.time_ns, last_ns);
      EXPECT_GT(capture.frame.sequence, last_sequence);
      EXPECT_EQ(grey.cols, opened.camera->stream().width);
      last_ns = capture.frame.time_ns;
      if (k == 0) first_ns = last_ns;
      lost += capture.frame.lost_before;
      last_sequence = capture.frame.sequence;
    }
    double least = 0, largest = 0;
    cv::minMaxLoc(grey, &least, &largest);
    EXPECT_GT(largest - least, 100);  // of their test patterns
    std::cout << ", " << 14e9 / static_cast<double>(last_ns - first_ns) << " frames/s, " << lost << " lost, grey "
              << least << " to " << largest << "\n";
  }
}

TEST(Libcamera, TheCameraTellsWhatItRefuses) {
  if (std::getenv("EDGESLAM_LIBCAMERA") == nullptr) GTEST_SKIP() << "no libcamera camera here";
  CameraOptions options;
  options.device = libcamera_prefix + listLibcameras().cameras.back().name;
  options.format = "Y16";
  OpenedCamera opened = openLibcameraCamera(options);
  EXPECT_FALSE(opened.camera);
  EXPECT_NE(opened.problem.find("has no format Y16; it offers"), std::string::npos) << opened.problem;
  options.format = "";
  options.controls = {{"Brightness", "7"}};
  opened = openLibcameraCamera(options);
  EXPECT_FALSE(opened.camera);
  std::cout << opened.problem << "\n";
  EXPECT_NE(opened.problem.find("Brightness 7"), std::string::npos) << opened.problem;
}

}  // namespace
}  // namespace edgeslam
