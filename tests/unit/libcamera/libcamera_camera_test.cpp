#include "drivers/libcamera/libcamera_camera.h"

#include <gtest/gtest.h>

#include "drivers/libcamera/manager.h"

namespace edgeslam {
namespace {

TEST(LibcameraCamera, WhereThereIsNoneThatIsToldAndMayHeal) {
  CameraOptions options;
  options.device = "libcamera:/base/no/such/sensor";
  for (int i = 0; i < 2; ++i) {  // nothing is left open
    const OpenedCamera opened = openLibcameraCamera(options);
    EXPECT_FALSE(opened.camera);
    EXPECT_TRUE(opened.may_heal);
    EXPECT_NE(opened.problem.find("libcamera:/base/no/such/sensor: there is no such camera"), std::string::npos)
        << opened.problem;
  }
}

TEST(LibcameraCamera, ListingTellsTheVersion) {
  const LibcameraListing listing = listLibcameras();
  EXPECT_EQ(listing.problem, "");
  EXPECT_NE(listing.version, "");
}

// libcamera itself would end the program.
TEST(LibcameraCamera, ASecondManagerIsRefused) {
  const Manager first;
  EXPECT_EQ(first.problem(), "");
  EXPECT_NE(Manager().problem(), "");
  EXPECT_NE(listLibcameras().problem, "");
}

TEST(LibcameraCamera, FormatsGoThereAndBack) {
  for (const PixelFormat format : pixel_formats) EXPECT_EQ(knownFormat(libcameraFormat(format)), format);
  EXPECT_EQ(libcameraFormat(PixelFormat::bgr24), libcamera::PixelFormat::fromString("RGB888"));
  EXPECT_EQ(libcameraFormat(PixelFormat::grey), libcamera::PixelFormat::fromString("R8"));
  EXPECT_FALSE(knownFormat(libcamera::PixelFormat::fromString("XRGB8888")));
}

}  // namespace
}  // namespace edgeslam
