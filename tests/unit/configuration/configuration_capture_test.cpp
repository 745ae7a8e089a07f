#include "configuration/configuration_capture.h"

#include <gtest/gtest.h>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

CameraOptions captureOf(const std::string& text) {
  const TemporaryFolder folder;
  return readConfiguration(folder.write("file.yaml", text)).capture;
}

void expectCaptureRefused(const std::string& text, const std::string& part) {
  expectInputError([&] { captureOf(text); }, std::string("file.yaml:"), part);
}

std::string controlOf(const CameraOptions& options, const std::string& name) {
  for (const ControlSetting& control : options.controls) {
    if (control.name == name) return control.value;
  }
  return "(none)";
}

const char* const whole_capture =
    "capture:\n"
    "  device: /dev/v4l/by-id/usb-Maker-index0\n"
    "  format: YUYV\n"
    "  width: 640\n"
    "  height: 480\n"
    "  frame_rate: 29.97\n"
    "  region: [8, 0, 1280, 960]\n"
    "  exposure: 8.5\n"
    "  longest_exposure: 10\n"
    "  gain: auto\n"
    "  white_balance: 4500\n"
    "  focus: 0\n"
    "  power_line_frequency: off\n"
    "  controls: {brightness: -3, test_pattern: Gray Ramp}\n";

TEST(ConfigurationCapture, EveryKeyIsRead) {
  const CameraOptions options = captureOf(whole_capture);
  EXPECT_EQ(options.device, "/dev/v4l/by-id/usb-Maker-index0");
  EXPECT_EQ(options.format, "YUYV");
  EXPECT_EQ(options.width, 640);
  EXPECT_EQ(options.height, 480);
  EXPECT_EQ(options.frame_rate, 29.97);
  EXPECT_EQ(options.region, cv::Rect(8, 0, 1280, 960));
  EXPECT_EQ(options.longest_exposure_ms, 10);
  EXPECT_EQ(controlOf(options, "exposure"), "8.5");
  EXPECT_EQ(controlOf(options, "gain"), "auto");
  EXPECT_EQ(controlOf(options, "white_balance"), "4500");
  EXPECT_EQ(controlOf(options, "focus"), "0");
  EXPECT_EQ(controlOf(options, "power_line_frequency"), "off");
  EXPECT_EQ(controlOf(options, "brightness"), "-3");
  EXPECT_EQ(controlOf(options, "test_pattern"), "Gray Ramp");
}

TEST(ConfigurationCapture, WhatIsWrittenReadsBackAsTheSame) {
  const CameraOptions first = captureOf(whole_capture);
  const std::string text = formatCaptureSection(first);
  EXPECT_EQ(formatCaptureSection(captureOf(text)), text);
  EXPECT_EQ(captureOf(text).controls.size(), first.controls.size());
}

TEST(ConfigurationCapture, AControlIsSetOverWhatAnIncludedFileSays) {
  const TemporaryFolder folder;
  folder.write("base.yaml", "capture: {exposure: 8, gain: auto, controls: {brightness: 1, hue: 2}}\n");
  const CameraOptions options =
      readConfiguration(folder.write("robot.yaml", "include: base.yaml\ncapture: {exposure: 5, controls: {hue: 3}}\n"))
          .capture;
  EXPECT_EQ(options.controls.size(), 4U);
  EXPECT_EQ(controlOf(options, "exposure"), "5");
  EXPECT_EQ(controlOf(options, "gain"), "auto");
  EXPECT_EQ(controlOf(options, "brightness"), "1");
  EXPECT_EQ(controlOf(options, "hue"), "3");
  const std::string text = formatCaptureSection(options);
  EXPECT_EQ(formatCaptureSection(captureOf(text)), text);
}

TEST(ConfigurationCapture, ControlsWithCommasAndBracketsAreReadBack) {
  const CameraOptions first = captureOf("capture: {controls: {'Exposure, Auto': 'a [b', 'x}': '{', '# y': ': z'}}\n");
  const CameraOptions again = captureOf(formatCaptureSection(first));
  ASSERT_EQ(again.controls.size(), 3U);
  for (const ControlSetting& control : first.controls) EXPECT_EQ(controlOf(again, control.name), control.value);
}

TEST(ConfigurationCapture, WithoutTheSectionNothingIsAskedFor) {
  EXPECT_EQ(formatCaptureSection(captureOf("")), "");
  EXPECT_EQ(formatCaptureSection(captureOf("capture:\n")), "");
  EXPECT_TRUE(captureOf("").controls.empty());
}

// The driver's own controls before the shared ones, which may need an automatic off that these set.
TEST(ConfigurationCapture, ControlsComeInAnOrderThatDoesNotDependOnTheFiles) {
  const CameraOptions one = captureOf("capture: {exposure: 5, gain: 3, controls: {a: 1}}\n");
  const CameraOptions other = captureOf("capture: {controls: {a: 1}, gain: 3, exposure: 5}\n");
  ASSERT_EQ(one.controls.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(one.controls[i].name, other.controls[i].name);
  EXPECT_EQ(one.controls[0].name, "a");
}

TEST(ConfigurationCapture, MistakesAreToldWithLineAndKey) {
  expectCaptureRefused("capture: {devise: /dev/video0}\n", "capture.devise is not a key; did you mean capture.device?");
  expectCaptureRefused("capture: {device: [1]}\n", "capture.device: ");
  expectCaptureRefused("capture: {format: RGGB}\n", "capture.format: 'RGGB' is not known; expected one of GREY");
  expectCaptureRefused("capture: {width: 640}\n", "capture.width and capture.height go together");
  expectCaptureRefused("capture: {width: 4, height: 480}\n", "capture.width: ");
  expectCaptureRefused("capture: {frame_rate: .nan}\n", "capture.frame_rate: ");
  expectCaptureRefused("capture: {frame_rate: 0}\n", "0.1 to 1000 frames/s");
  expectCaptureRefused("capture: {longest_exposure: -1}\n", "capture.longest_exposure: ");
  for (const char* region : {"[1, 2, 3]", "[0, 0, 640, 480, 1]", "[-1, 0, 640, 480]", "[0, 0, 0, 480]",
                             "[0, 0, 1e9, 480]", "[0.5, 0, 640, 480]", "640x480"}) {
    expectCaptureRefused(std::string("capture: {region: ") + region + "}\n", "capture.region: four whole numbers");
  }
  expectCaptureRefused("capture: {exposure: long}\n",
                       "capture.exposure: 'long' is not possible; expected auto or a number");
  expectCaptureRefused("capture: {exposure: -3}\n", "capture.exposure: '-3'");
  expectCaptureRefused("capture: {gain: [1]}\n", "capture.gain: ");
  expectCaptureRefused("capture: {power_line_frequency: 55}\n", "expected 50, 60, off or auto");
  expectCaptureRefused("capture: {controls: 3}\n", "capture.controls: a mapping");
  expectCaptureRefused("capture: {controls: {brightness: [1]}}\n", "capture.controls.brightness: a number or a word");
  expectCaptureRefused("capture: {controls: {gain: 3}}\n", "is given as capture.gain");
  expectCaptureRefused("capture: {controls: {a: 1, a: 2}}\n", "capture.controls.a is given twice");
  expectCaptureRefused("capture:\n  device: a\n  device: b\n", "capture.device is given twice");
}

}  // namespace
}  // namespace edgeslam
