#include "drivers/v4l2/camera_controls.h"

#include <gtest/gtest.h>

#include "unit/v4l2/fake_driver.h"

namespace edgeslam {
namespace {

class CameraControlsTest : public testing::Test {
 protected:
  void SetUp() override {
    driver_.controls = {
        {V4L2_CID_BRIGHTNESS, {"Brightness", V4L2_CTRL_TYPE_INTEGER, -10, 10, 2, 0, {}}},
        {V4L2_CID_GAIN, {"Gain", V4L2_CTRL_TYPE_INTEGER, 0, 100, 1, 20, {}}},
        {V4L2_CID_AUTOGAIN, {"Gain, Automatic", V4L2_CTRL_TYPE_BOOLEAN, 0, 1, 1, 1, {}}},
        {V4L2_CID_POWER_LINE_FREQUENCY,
         {"Power Line Frequency", V4L2_CTRL_TYPE_MENU, 0, 2, 1, 1, {{0, "Disabled"}, {1, "50 Hz"}, {2, "60 Hz"}}}},
        {V4L2_CID_EXPOSURE_AUTO,
         {"Auto Exposure", V4L2_CTRL_TYPE_MENU, 0, 3, 1, 3, {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}}}},
        {V4L2_CID_EXPOSURE_ABSOLUTE, {"Exposure Time, Absolute", V4L2_CTRL_TYPE_INTEGER, 3, 2047, 1, 250, {}}},
        {V4L2_CID_MIN_BUFFERS_FOR_CAPTURE,
         {"Min Number of Buffers", V4L2_CTRL_TYPE_INTEGER, 1, 32, 1, 1, {}, V4L2_CTRL_FLAG_READ_ONLY}},
    };
  }
  std::string set(const std::string& name, const std::string& value) {
    const OpenedDevice opened = openCaptureDevice(driver_, "/dev/video7");
    return setControl(*opened.device, cameraControls(*opened.device), {name, value}).text;
  }
  std::int32_t value(std::uint32_t id) { return driver_.controls.at(id).value; }

  FakeDriver driver_;
};

TEST_F(CameraControlsTest, AllAreListedWithPlainNames) {
  const OpenedDevice opened = openCaptureDevice(driver_, "/dev/video7");
  const std::vector<CameraControl> controls = cameraControls(*opened.device);
  ASSERT_EQ(controls.size(), driver_.controls.size());
  const auto has = [&](const std::string& name) {
    return std::any_of(controls.begin(), controls.end(), [&](const auto& control) { return control.name == name; });
  };
  for (const char* name : {"brightness", "gain_automatic", "exposure_time_absolute", "auto_exposure"}) {
    EXPECT_TRUE(has(name)) << name;
  }
}

TEST_F(CameraControlsTest, SharedNamesSetTheValueAndItsAutomatic) {
  EXPECT_EQ(set("exposure", "8.5"), "");
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 85);
  EXPECT_EQ(set("exposure", "auto"), "");
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(set("gain", "33"), "");
  EXPECT_EQ(value(V4L2_CID_AUTOGAIN), 0);
  EXPECT_EQ(value(V4L2_CID_GAIN), 33);
  EXPECT_EQ(set("power_line_frequency", "60"), "");
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), 2);
  EXPECT_EQ(set("power_line_frequency", "off"), "");
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), 0);
}

TEST_F(CameraControlsTest, TheDriversOwnNamesTakeNumbersAndWords) {
  EXPECT_EQ(set("brightness", "-4"), "");
  EXPECT_EQ(value(V4L2_CID_BRIGHTNESS), -4);
  EXPECT_EQ(set("auto_exposure", "Manual Mode"), "");
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), 1);
  EXPECT_EQ(set("gain_automatic", "false"), "");
  EXPECT_EQ(value(V4L2_CID_AUTOGAIN), 0);
}

TEST_F(CameraControlsTest, WhatIsNotAllowedIsToldWithTheRangeAndSetsNothing) {
  const auto expectProblem = [&](const std::string& name, const std::string& text, const std::string& part) {
    const std::string problem = set(name, text);
    EXPECT_EQ(problem.rfind("/dev/video7: " + name + " " + text + ": ", 0), 0U) << problem;
    EXPECT_NE(problem.find(part), std::string::npos) << problem;
  };
  expectProblem("brightness", "11", "-10 to 10 in steps of 2");
  expectProblem("brightness", "3", "-10 to 10 in steps of 2");
  expectProblem("brightness", "1e99", "-10 to 10");
  expectProblem("brightness", "bright", "-10 to 10");
  expectProblem("exposure", "500", "0.3 to 204.7 ms");
  expectProblem("exposure", "nan", "0.3 to 204.7 ms");
  expectProblem("auto_exposure", "2", "1 (Manual Mode), 3 (Aperture Priority Mode)");
  expectProblem("gain_automatic", "maybe", "true or false");
  expectProblem("power_line_frequency", "55", "50, 60, off or auto");
  expectProblem("power_line_frequency", "auto", "2 (60 Hz)");
  expectProblem("focus", "10", "no control of its focus");
  expectProblem("focus", "auto", "no automatic focus");
  expectProblem("brightnes", "1", "brightness");
  expectProblem("min_number_of_buffers", "2", "can only be read");
  EXPECT_TRUE(driver_.set_controls.empty());
}

TEST_F(CameraControlsTest, ADriverThatRefusesIsToldWithTheRange) {
  driver_.failures[VIDIOC_S_CTRL] = {EBUSY};
  const std::string problem = set("brightness", "2");
  EXPECT_NE(problem.find("the driver refuses it"), std::string::npos) << problem;
  EXPECT_NE(problem.find("-10 to 10 in steps of 2"), std::string::npos) << problem;
}

TEST_F(CameraControlsTest, ADriverWithoutControlsHasNone) {
  driver_.controls.clear();
  EXPECT_NE(set("brightness", "1").find("it has none"), std::string::npos);
}

}  // namespace
}  // namespace edgeslam
