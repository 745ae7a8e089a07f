#include "drivers/libcamera/control_values.h"

#include <gtest/gtest.h>
#include <libcamera/control_ids.h>

namespace edgeslam {
namespace {

namespace controls = libcamera::controls;
using libcamera::ControlInfo;

class ControlValuesTest : public testing::Test {
 protected:
  std::string add(const CameraOptions& options) {
    list_ = libcamera::ControlList(offered_);
    return addControls(options, offered_, list_);
  }
  std::string add(const std::string& name, const std::string& value) {
    CameraOptions options;
    options.controls = {{name, value}};
    return add(options);
  }

  libcamera::ControlInfoMap offered_{
      {{&controls::AeEnable, ControlInfo(false, true)},
       {&controls::ExposureTime, ControlInfo(std::int32_t{100}, std::int32_t{66666})},
       {&controls::AnalogueGain, ControlInfo(1.0F, 8.0F)},
       {&controls::AwbEnable, ControlInfo(false, true)},
       {&controls::Brightness, ControlInfo(-1.0F, 1.0F)},
       {&controls::FrameDurationLimits, ControlInfo(std::int64_t{8333}, std::int64_t{1000000})}},
      controls::controls};
  libcamera::ControlList list_{offered_};
};

TEST_F(ControlValuesTest, SharedNamesBecomeLibcamerasControls) {
  EXPECT_EQ(add("exposure", "8.5"), "");
  EXPECT_EQ(list_.get(controls::ExposureTime), 8500);
  EXPECT_EQ(list_.get(controls::AeEnable), false);
  EXPECT_EQ(add("exposure", "auto"), "");
  EXPECT_EQ(list_.get(controls::AeEnable), true);
  EXPECT_EQ(add("gain", "2.5"), "");
  EXPECT_EQ(list_.get(controls::AnalogueGain), 2.5F);
  EXPECT_EQ(add("white_balance", "auto"), "");
  EXPECT_EQ(list_.get(controls::AwbEnable), true);
}

TEST_F(ControlValuesTest, TheCamerasOwnNamesAreTaken) {
  EXPECT_EQ(add("Brightness", "-0.5"), "");
  EXPECT_EQ(list_.get(controls::Brightness), -0.5F);
  EXPECT_EQ(add("AwbEnable", "false"), "");
  EXPECT_EQ(list_.get(controls::AwbEnable), false);
}

TEST_F(ControlValuesTest, TheFrameRateBecomesTheFramesDuration) {
  CameraOptions options;
  options.frame_rate = 40;
  EXPECT_EQ(add(options), "");
  const auto limits = list_.get(controls::FrameDurationLimits);
  ASSERT_TRUE(limits);
  EXPECT_EQ((*limits)[0], 25000);
  EXPECT_EQ((*limits)[1], 25000);
  options.frame_rate = 500;
  EXPECT_NE(add(options).find("8333"), std::string::npos) << add(options);
}

TEST_F(ControlValuesTest, WhatIsNotAllowedIsToldWithTheRange) {
  const auto expectProblem = [&](const std::string& name, const std::string& value, const std::string& part) {
    const std::string problem = add(name, value);
    EXPECT_EQ(problem.rfind(name + " " + value + ": ", 0), 0U) << problem;
    EXPECT_NE(problem.find(part), std::string::npos) << problem;
  };
  expectProblem("exposure", "500", "66666");
  expectProblem("exposure", "1e30", "66666");
  expectProblem("exposure", "long", "neither auto nor a number");
  expectProblem("gain", "0.5", "8.0");
  expectProblem("focus", "1", "no control AfMode");
  expectProblem("power_line_frequency", "55", "50, 60, off or auto");
  expectProblem("Brightnes", "1", "Brightness");
  CameraOptions options;
  options.region = {0, 0, 100, 100};
  EXPECT_NE(add(options).find("ScalerCrop"), std::string::npos);
}

}  // namespace
}  // namespace edgeslam
