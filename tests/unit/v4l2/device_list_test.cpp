#include "drivers/v4l2/device_list.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "unit/files/temporary_folder.h"
#include "unit/v4l2/fake_driver.h"

namespace edgeslam {
namespace {

TEST(DeviceList, CamerasComeInOrderWithTheirStableNames) {
  const TemporaryFolder dev;
  for (const char* name : {"video10", "video2", "video0", "video", "video1x", "vbi0"}) dev.write(name, "");
  std::filesystem::create_directories(dev.path("v4l/by-id"));
  std::filesystem::create_directories(dev.path("v4l/by-path"));
  std::filesystem::create_symlink("../../video2", dev.path("v4l/by-id/usb-Maker_Camera-video-index0"));
  std::filesystem::create_symlink("../../video2", dev.path("v4l/by-path/pci-0000:00:14.0-usb-0:1:1.0-video-index0"));
  std::filesystem::create_symlink("../../video10", dev.path("v4l/by-path/platform-vivid.0-video-index0"));

  FakeDriver driver;
  const std::vector<ListedCamera> cameras = listV4l2Cameras(dev.path(), driver);
  ASSERT_EQ(cameras.size(), 3U);
  EXPECT_EQ(cameras[0].stableName(), dev.path("video0"));
  EXPECT_EQ(cameras[1].stableName(), dev.path("v4l/by-id/usb-Maker_Camera-video-index0"));
  EXPECT_EQ(cameras[2].stableName(), dev.path("v4l/by-path/platform-vivid.0-video-index0"));
  EXPECT_EQ(cameras[0].card, "Fake");
  EXPECT_EQ(cameras[0].formats.size(), driver.formats.size());
  EXPECT_EQ(cameras[0].formats[0].sizes[1].rates, (std::vector<double>{60, 30}));
  EXPECT_EQ(driver.open_files, 0);
}

TEST(DeviceList, WhatIsNoCameraIsLeftOutAndWhatCannotBeOpenedIsTold) {
  const TemporaryFolder dev;
  dev.write("video0", "");
  FakeDriver driver;
  driver.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_TRUE(listV4l2Cameras(dev.path(), driver).empty());
  driver.open_failure = EACCES;
  const std::vector<ListedCamera> cameras = listV4l2Cameras(dev.path(), driver);
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_NE(cameras[0].problem.find("group video"), std::string::npos);
}

TEST(DeviceList, NoDevicesAreAnEmptyList) {
  FakeDriver driver;
  EXPECT_TRUE(listV4l2Cameras("/nowhere", driver).empty());
}

}  // namespace
}  // namespace edgeslam
