#include "drivers/v4l2/stream_setup.h"

#include <gtest/gtest.h>

#include "unit/v4l2/fake_driver.h"

namespace edgeslam {
namespace {

constexpr std::uint32_t mjpg = v4l2_fourcc('M', 'J', 'P', 'G');

class StreamSetupTest : public testing::Test {
 protected:
  SettledStream settle(const CameraOptions& options) {
    const OpenedDevice opened = openCaptureDevice(driver_, "/dev/video7");
    EXPECT_TRUE(opened.device);
    return settleStream(*opened.device, options);
  }
  void expectProblem(const CameraOptions& options, const std::vector<std::string>& parts) {
    const V4l2Problem problem = settle(options).problem;
    EXPECT_FALSE(problem.may_heal);
    for (const std::string& part : parts) EXPECT_NE(problem.text.find(part), std::string::npos) << problem.text;
  }

  FakeDriver driver_;
};

TEST_F(StreamSetupTest, TheFormatOfTheLeastWorkIsTakenAtTheDriversSize) {
  const SettledStream settled = settle({});
  EXPECT_EQ(settled.problem.text, "");
  EXPECT_EQ(settled.setup.layout.format, PixelFormat::grey);
  EXPECT_EQ(settled.setup.layout.width, 64);
  EXPECT_EQ(settled.setup.layout.height, 48);
  EXPECT_EQ(settled.setup.frame_rate, 30);
}

TEST_F(StreamSetupTest, ASizeThatOnlyAnotherFormatHasIsTakenFromIt) {
  CameraOptions options;
  options.width = 32;
  options.height = 24;
  const SettledStream settled = settle(options);
  EXPECT_EQ(settled.problem.text, "");
  EXPECT_EQ(settled.setup.layout.format, PixelFormat::yuyv);
  EXPECT_EQ(settled.setup.frame_rate, 30);  // 60 is offered, too
}

TEST_F(StreamSetupTest, AFasterFormatIsTakenRatherThanASlowOneOfLessWork) {
  driver_.formats = {{v4l2_fourcc('Y', 'U', 'Y', 'V'), {{64, 48, {10}}}}, {mjpg, {{64, 48, {30}}}}};
  const SettledStream settled = settle({});
  EXPECT_EQ(settled.setup.layout.format, PixelFormat::mjpeg);
  EXPECT_EQ(settled.setup.frame_rate, 30);
}

TEST_F(StreamSetupTest, WhatIsAskedForIsTaken) {
  CameraOptions options;
  options.format = "YUYV";
  options.width = 32;
  options.height = 24;
  options.frame_rate = 60;
  const SettledStream settled = settle(options);
  EXPECT_EQ(settled.problem.text, "");
  EXPECT_EQ(settled.setup.layout.format, PixelFormat::yuyv);
  EXPECT_EQ(settled.setup.frame_rate, 60);
}

TEST_F(StreamSetupTest, WhatTheCameraDoesNotOfferIsToldWithWhatItDoes) {
  CameraOptions options;
  options.format = "NV12";
  expectProblem(options, {"/dev/video7: has no format NV12", "YUYV 64 x 48, 32 x 24; GREY 64 x 48"});
  options.format = "GREY";
  options.width = 640;
  options.height = 480;
  expectProblem(options, {"GREY 640 x 480", "would give 64 x 48", "YUYV 64 x 48"});
  options = {};
  options.frame_rate = 50;
  expectProblem(options, {"50 frames/s", "would give 15 frames/s", "offers 30, 15 frames/s"});
  driver_.formats = {{v4l2_fourcc('p', 'B', 'A', 'A'), {{64, 48, {30}}}}};
  expectProblem({}, {"no format that is known here"});
}

TEST_F(StreamSetupTest, ARegionIsSetOrItsBoundsAreTold) {
  CameraOptions options;
  options.region = {8, 4, 64, 48};
  expectProblem(options, {"no choice of a region"});
  driver_.has_crop = true;
  EXPECT_EQ(settle(options).problem.text, "");
  EXPECT_EQ(driver_.crop.left, 8);
  EXPECT_EQ(driver_.crop.height, 48U);
  options.region = {0, 0, 640, 480};
  expectProblem(options, {"region [0, 0, 640, 480]", "[0, 0, 128, 96]"});
}

}  // namespace
}  // namespace edgeslam
