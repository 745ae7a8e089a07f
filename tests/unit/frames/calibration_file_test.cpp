#include "frames/calibration_file.h"

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const std::string own_calibration =
    "# a camera\nwidth: 640\nheight: 480\nfx: 535.4\nfy: 539.2\ncx: 320.1\ncy: 247.6\n"
    "k1: 0.045\nk2: -0.11\np1: -0.0012\np2: 0.0007\nfps: 30.0\n";

const std::string ros_calibration =
    "image_width: 640\nimage_height: 480\ncamera_name: head\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
    "  data: [535.4, 0, 320.1, 0, 539.2, 247.6, 0, 0, 1]\ndistortion_model: plumb_bob\n"
    "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.1, 0.2, 0.3, 0.4, 0.5]\n";

const std::string kalibr_calibration =
    "cam0:\n  cam_overlaps: []\n  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]\n"
    "  distortion_model: equidistant\n  intrinsics: [190.9, 190.8, 254.9, 256.8]\n"
    "  resolution: [512, 512]\n  rostopic: /cam0/image_raw\n";

const std::string euroc_calibration =
    "# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor cam0\nT_BS:\n  cols: 4\n  rows: 4\n"
    "  data: [1, 0, 0, 0,\n         0, 1, 0, 0,\n         0, 0, 1, 0,\n         0, 0, 0, 1]\nrate_hz: 20\n"
    "resolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0.0002, 1.7e-05]\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "'");
  return text.replace(at, from.size(), to);
}

Camera calibrationOf(const std::string& text) {
  const TemporaryFolder folder;
  return readCalibration(folder.write("c.yaml", text));
}

template <typename... Texts>
void expectCalibrationRefused(const std::string& text, const Texts&... messages) {
  SCOPED_TRACE(text);
  expectInputError([&] { calibrationOf(text); }, "c.yaml", messages...);
}

TEST(CalibrationFile, ReadsOurs) {
  const Camera camera = calibrationOf(own_calibration);
  EXPECT_EQ(camera.model, CameraModel::pinhole_radial_tangential);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.fx, 535.4);
  EXPECT_EQ(camera.fy, 539.2);
  EXPECT_EQ(camera.cx, 320.1);
  EXPECT_EQ(camera.cy, 247.6);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{0.045, -0.11, -0.0012, 0.0007, 0}));
  EXPECT_EQ(calibrationOf(own_calibration + "k3: 0.5\n").distortion[4], 0.5);
  EXPECT_EQ(calibrationOf(own_calibration + "board_cols: 9\nboard_rows: 6\nboard_square: 0.03\n").fx, 535.4);
}

TEST(CalibrationFile, ReadsOurFisheye) {
  const Camera camera = calibrationOf(
      "model: kannala_brandt\nwidth: 64\nheight: 48\nfx: 20\nfy: 21\ncx: 31\ncy: 23\nk1: 1\nk2: 2\nk3: 3\nk4: 4\n");
  EXPECT_EQ(camera.model, CameraModel::kannala_brandt);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{1, 2, 3, 4, 0}));
}

TEST(CalibrationFile, ReadsRosCameraInfo) {
  const Camera camera = calibrationOf(ros_calibration);
  EXPECT_EQ(camera.model, CameraModel::pinhole_radial_tangential);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.fx, 535.4);
  EXPECT_EQ(camera.fy, 539.2);
  EXPECT_EQ(camera.cx, 320.1);
  EXPECT_EQ(camera.cy, 247.6);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{0.1, 0.2, 0.3, 0.4, 0.5}));
  const std::string fisheye = replaced(replaced(ros_calibration, "plumb_bob", "equidistant"), ", 0.5]", "]");
  EXPECT_EQ(calibrationOf(fisheye).model, CameraModel::kannala_brandt);
  const std::string rational = replaced(ros_calibration, "plumb_bob", "rational_polynomial");
  EXPECT_EQ(calibrationOf(replaced(rational, "0.5]", "0.5, 0, 0, 0]")).distortion[4], 0.5);
  expectCalibrationRefused(replaced(rational, "0.5]", "0.5, 0, 0.1, 0]"), ":12: ", "rational", "plumb_bob");
}

TEST(CalibrationFile, ReadsKalibrChains) {
  const Camera camera = calibrationOf(kalibr_calibration);
  EXPECT_EQ(camera.model, CameraModel::kannala_brandt);
  EXPECT_EQ(camera.width, 512);
  EXPECT_EQ(camera.fx, 190.9);
  EXPECT_EQ(camera.cy, 256.8);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{0.1, 0.2, 0.3, 0.4, 0}));
  EXPECT_EQ(calibrationOf(replaced(kalibr_calibration, "equidistant", "radtan")).model,
            CameraModel::pinhole_radial_tangential);
}

TEST(CalibrationFile, ReadsTheReadoutOfARollingShutter) {
  EXPECT_EQ(calibrationOf(own_calibration).readout_s, 0);
  EXPECT_EQ(calibrationOf(own_calibration + "readout: 0.02\n").readout_s, 0.02);
  EXPECT_EQ(calibrationOf(own_calibration + "readout: -0.2\n").readout_s, -0.2);
  expectCalibrationRefused(own_calibration + "readout: 0.201\n", "c.yaml:13", "readout", "-0.2 to 0.2");
  expectCalibrationRefused(own_calibration + "readout: -20\n", "c.yaml:13", "readout", "-0.2 to 0.2");
  expectCalibrationRefused(own_calibration + "readout: .nan\n", "c.yaml:13", "'readout'", "finite");
  expectCalibrationRefused(own_calibration + "readout: .inf\n", "c.yaml:13", "'readout'", "finite");
  expectCalibrationRefused(own_calibration + "readout: 20ms\n", "c.yaml:13", "'readout'", "'20ms'");
  expectCalibrationRefused(own_calibration + "readuot: 0.02\n", "c.yaml:13", "'readout' meant");
}

// Kalibr's delay is from row to row.
TEST(CalibrationFile, ReadsTheLineDelayOfKalibrChains) {
  EXPECT_EQ(calibrationOf(kalibr_calibration).readout_s, 0);
  EXPECT_DOUBLE_EQ(calibrationOf(kalibr_calibration + "  line_delay: 4.0e-05\n").readout_s, 4.0e-05 * 511);
  expectCalibrationRefused(kalibr_calibration + "  line_delay: 0.02\n", "c.yaml:9", "readout", "-0.2 to 0.2");
  expectCalibrationRefused(kalibr_calibration + "  line_delay: .nan\n", "c.yaml:9", "'line_delay'", "finite");
}

TEST(CalibrationFile, IsReadBackToTheLastBitAfterItWasWritten) {
  for (const char* readout : {"", "readout: 0.0181000000000000013\n", "readout: -1e-300\n"}) {
    const Camera camera = calibrationOf(own_calibration + readout);
    EXPECT_EQ(calibrationOf(formatCalibrationFile(camera)), camera) << readout;
  }
  EXPECT_EQ(formatCalibrationFile(calibrationOf(own_calibration)).find("readout"), std::string::npos);
}

TEST(CalibrationFile, ReadsEurocSensors) {
  const Camera camera = calibrationOf(euroc_calibration);
  EXPECT_EQ(camera.model, CameraModel::pinhole_radial_tangential);
  EXPECT_EQ(camera.width, 752);
  EXPECT_EQ(camera.fy, 457.296);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{-0.28, 0.07, 0.0002, 1.7e-05, 0}));
}

TEST(CalibrationFile, ImpossibleValuesAreToldByLineAndKey) {
  expectCalibrationRefused(replaced(own_calibration, "535.4", ".nan"), "c.yaml:4", "fx", "finite");
  expectCalibrationRefused(replaced(own_calibration, "535.4", "nan"), "c.yaml:4", "fx", "finite");
  expectCalibrationRefused(replaced(own_calibration, "535.4", "1e999"), "c.yaml:4", "fx");
  expectCalibrationRefused(replaced(own_calibration, "535.4", "-535.4"), "c.yaml:4", "focal length fx",
                           "greater than 0");
  expectCalibrationRefused(replaced(own_calibration, "539.2", "0"), "c.yaml:5", "focal length fy");
  expectCalibrationRefused(replaced(own_calibration, "320.1", "640"), "c.yaml:6", "cx", "639");
  expectCalibrationRefused(replaced(own_calibration, "247.6", "-1"), "c.yaml:7", "cy", "479");
  expectCalibrationRefused(replaced(own_calibration, "640", "0"), "c.yaml:2", "width");
  expectCalibrationRefused(replaced(own_calibration, "640", "640.5"), "c.yaml:2", "width", "whole");
  expectCalibrationRefused(replaced(own_calibration, "480", "1e300"), "c.yaml:3", "height");
  expectCalibrationRefused(replaced(own_calibration, "0.045", ".inf"), "c.yaml:8", "k1", "finite");
  expectCalibrationRefused(replaced(own_calibration, "30.0", "0"), "c.yaml:12", "fps");
  expectCalibrationRefused(replaced(kalibr_calibration, "190.9", "-190.9"), "c.yaml:6", "fx");
  expectCalibrationRefused(replaced(euroc_calibration, "458.654", ".nan"), "intrinsics", "finite");
  expectCalibrationRefused(replaced(ros_calibration, "[535.4", "[0"), "c.yaml", "fx");
  // What a saved map would not take.
  expectCalibrationRefused(replaced(own_calibration, "535.4", "1e13"), "c.yaml:4", "fx", "1e6");
  expectCalibrationRefused(replaced(own_calibration, "539.2", "1e-13"), "c.yaml:5", "fy", "0.001");
  expectCalibrationRefused(replaced(own_calibration, "0.045", "1e13"), "c.yaml:8", "distortion");
}

TEST(CalibrationFile, UnknownMissingAndRepeatedKeysAreToldWithWhatWasMeant) {
  expectCalibrationRefused(replaced(own_calibration, "height", "heigth"), "c.yaml:3", "'heigth'", "'height' meant");
  expectCalibrationRefused(own_calibration + "exposure: 3\n", "c.yaml:13", "unknown key 'exposure'");
  expectCalibrationRefused(own_calibration + "k4: 3\n", "c.yaml:13", "unknown key 'k4'");
  expectCalibrationRefused(own_calibration + "fx: 500\n", "c.yaml:13", "'fx'", "twice");
  expectCalibrationRefused(replaced(own_calibration, "fx: 535.4\n", ""), "'fx' is missing");
  expectCalibrationRefused(replaced(kalibr_calibration, "intrinsics", "intrinsic"), "'intrinsics' is missing",
                           "'intrinsic'");
  expectCalibrationRefused(replaced(ros_calibration, "distortion_model: plumb_bob\n", ""),
                           "'distortion_model' is missing");
}

TEST(CalibrationFile, WrongTypesAndSizesAreToldByLineAndKey) {
  expectCalibrationRefused(replaced(own_calibration, "535.4", "wide"), "c.yaml:4", "fx", "'wide'");
  expectCalibrationRefused(replaced(own_calibration, "535.4", "[1, 2]"), "c.yaml:4", "fx", "number");
  expectCalibrationRefused(replaced(own_calibration, "535.4", ""), "c.yaml:4", "fx");
  expectCalibrationRefused(own_calibration + "model: fisheye\n", "c.yaml:13", "kannala_brandt", "'fisheye'");
  expectCalibrationRefused(replaced(kalibr_calibration, "[0.1, 0.2, 0.3, 0.4]", "[0.1, 0.2]"), "c.yaml:4",
                           "distortion_coeffs", "4", "2");
  expectCalibrationRefused(replaced(kalibr_calibration, "[512, 512]", "[512]"), "c.yaml:7", "resolution");
  expectCalibrationRefused(replaced(kalibr_calibration, "[512, 512]", "[512, 1e99]"), "c.yaml:7", "resolution");
  expectCalibrationRefused(replaced(kalibr_calibration, "equidistant", "omni"), "c.yaml:5", "distortion_model",
                           "'omni'");
  expectCalibrationRefused(replaced(kalibr_calibration, "pinhole", "omni"), "c.yaml:3", "camera_model", "'omni'");
  expectCalibrationRefused(replaced(ros_calibration, "plumb_bob", "equidistant"), "c.yaml:12", "4", "5");
  expectCalibrationRefused(replaced(ros_calibration, ", 0, 0, 1]", "]"), "c.yaml:7", "data", "9");
}

TEST(CalibrationFile, WhatIsNoCalibrationIsRefused) {
  expectCalibrationRefused("");
  expectCalibrationRefused("- 1\n- 2\n");
  expectCalibrationRefused("just words");
  expectCalibrationRefused("fx: [1, 2\nfy: 3\n", "YAML");
  expectCalibrationRefused("cam0: 3\n", "c.yaml:1");
  expectCalibrationRefused("[a, b]: 3\n", "c.yaml:1");
  expectCalibrationRefused(std::string(2000, '['));
  expectCalibrationRefused(std::string(2 << 20, '#'), "too large");
  expectCalibrationRefused(std::string("fx: \0\xff\xfe", 7));
  expectInputError([] { readCalibration("/nonexistent/camera.yaml"); }, "/nonexistent/camera.yaml", "no such");
}

}  // namespace
}  // namespace edgeslam
