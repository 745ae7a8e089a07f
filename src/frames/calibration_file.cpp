#include "frames/calibration_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "edgeslam/input_error.h"
#include "files/format_text.h"
#include "frames/yaml_section.h"

namespace edgeslam {
namespace {

// Names of the keys that the values of a camera were read from, for messages.
struct CameraKeys {
  std::string width, height, fx, fy, cx, cy, distortion;
};

void checkCamera(const YamlSection& section, const Camera& camera, const CameraKeys& keys) {
  if (camera.width < 1 || camera.width > largest_camera_side) {
    section.failAt(keys.width, "the image's width must be 1 to 32768 pixels, it is " + std::to_string(camera.width));
  }
  if (camera.height < 1 || camera.height > largest_camera_side) {
    section.failAt(keys.height, "the image's height must be 1 to 32768 pixels, it is " + std::to_string(camera.height));
  }
  const auto isFocalLength = [](double f) { return f >= least_focal_length_px && f <= largest_focal_length_px; };
  if (!isFocalLength(camera.fx)) section.failAt(keys.fx, "the focal length fx must be greater than 0, 0.001 to 1e6 px");
  if (!isFocalLength(camera.fy)) section.failAt(keys.fy, "the focal length fy must be greater than 0, 0.001 to 1e6 px");
  if (!(camera.cx >= 0 && camera.cx <= camera.width - 1)) {
    section.failAt(keys.cx, "the centre cx must lie in the image, in 0 to " + std::to_string(camera.width - 1));
  }
  if (!(camera.cy >= 0 && camera.cy <= camera.height - 1)) {
    section.failAt(keys.cy, "the centre cy must lie in the image, in 0 to " + std::to_string(camera.height - 1));
  }
  for (const double coefficient : camera.distortion) {
    if (std::abs(coefficient) > largest_distortion) {
      section.failAt(keys.distortion, "the coefficients of the distortion must be -1e6 to 1e6");
    }
  }
}

double readReadout(const YamlSection& section, const std::string& key, double times) {
  const double readout_s = section.number(key) * times;
  if (std::abs(readout_s) > longest_readout_s) {
    section.failAt(key, "the readout must be -0.2 to 0.2 seconds, from the first row's reading to the last one's");
  }
  return readout_s;
}

Camera readOwn(const YamlSection& section) {
  std::vector<std::string> known{"width", "height", "fx",         "fy",         "cx",           "cy",    "k1",
                                 "k2",    "fps",    "board_cols", "board_rows", "board_square", "model", "readout"};
  Camera camera;
  std::vector<std::string> distortion{"k1", "k2", "p1", "p2", "k3"};
  if (section.has("model")) {
    const std::string model = section.text("model");
    if (model == "kannala_brandt") {
      camera.model = CameraModel::kannala_brandt;
      distortion = {"k1", "k2", "k3", "k4"};
    } else if (model != "pinhole_radial_tangential") {
      section.failAt("model", "'model' must be pinhole_radial_tangential or kannala_brandt, found '" + model + "'");
    }
  }
  known.insert(known.end(), distortion.begin(), distortion.end());
  section.rejectUnknownKeys(known);
  camera.width = section.wholeNumber("width");
  camera.height = section.wholeNumber("height");
  camera.fx = section.number("fx");
  camera.fy = section.number("fy");
  camera.cx = section.number("cx");
  camera.cy = section.number("cy");
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    if (!section.has(distortion[i])) continue;
    camera.distortion[i] = section.number(distortion[i]);
    if (std::abs(camera.distortion[i]) > largest_distortion) {
      section.failAt(distortion[i], "the coefficients of the distortion must be -1e6 to 1e6");
    }
  }
  if (section.has("fps") && !(section.number("fps") > 0)) section.failAt("fps", "'fps' must be greater than 0");
  checkCamera(section, camera, {"width", "height", "fx", "fy", "cx", "cy", "width"});
  if (section.has("readout")) camera.readout_s = readReadout(section, "readout", 1);
  return camera;
}

void setDistortion(Camera& camera, CameraModel model, const std::vector<double>& coefficients) {
  camera.model = model;
  std::copy_n(coefficients.begin(), std::min(coefficients.size(), camera.distortion.size()), camera.distortion.begin());
}

Camera readRos(const YamlSection& section) {
  Camera camera;
  camera.width = section.wholeNumber("image_width");
  camera.height = section.wholeNumber("image_height");
  const YamlSection matrix = section.section("camera_matrix");
  const std::vector<double> k = matrix.numbers("data");
  matrix.expectSize("data", k, {9});
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  const YamlSection coefficients = section.section("distortion_coefficients");
  const std::vector<double> d = coefficients.numbers("data");
  const std::string model = section.text("distortion_model");
  if (model == "plumb_bob") {
    coefficients.expectSize("data", d, {4, 5});
    setDistortion(camera, CameraModel::pinhole_radial_tangential, d);
  } else if (model == "rational_polynomial") {
    coefficients.expectSize("data", d, {5, 8});
    if (std::any_of(d.begin() + 5, d.end(), [](double value) { return value != 0; })) {
      coefficients.failAt("data", "the rational model's k4 to k6 are not supported; calibrate with plumb_bob");
    }
    setDistortion(camera, CameraModel::pinhole_radial_tangential, d);
  } else if (model == "equidistant") {
    coefficients.expectSize("data", d, {4});
    setDistortion(camera, CameraModel::kannala_brandt, d);
  } else {
    section.failAt("distortion_model", "'distortion_model' must be plumb_bob or equidistant, found '" + model + "'");
  }
  checkCamera(section, camera,
              {"image_width", "image_height", "camera_matrix", "camera_matrix", "camera_matrix", "camera_matrix",
               "distortion_coefficients"});
  return camera;
}

// Kalibr's and EuRoC's files are built alike and differ in names.
Camera readCalibrationLists(const YamlSection& section, const std::string& coefficients_key,
                            const std::string& radial_tangential_name) {
  Camera camera;
  const std::string camera_model = section.text("camera_model");
  if (camera_model != "pinhole") {
    section.failAt("camera_model", "'camera_model' must be pinhole, found '" + camera_model + "'");
  }
  const std::vector<double> resolution = section.numbers("resolution");
  section.expectSize("resolution", resolution, {2});
  for (const double side : resolution) {
    if (side != std::floor(side) || std::abs(side) > 1e6) {
      section.failAt("resolution", "'resolution' must be two whole numbers");
    }
  }
  camera.width = static_cast<int>(resolution[0]);
  camera.height = static_cast<int>(resolution[1]);
  const std::vector<double> intrinsics = section.numbers("intrinsics");
  section.expectSize("intrinsics", intrinsics, {4});
  camera.fx = intrinsics[0];
  camera.fy = intrinsics[1];
  camera.cx = intrinsics[2];
  camera.cy = intrinsics[3];
  const std::string model = section.text("distortion_model");
  if (model == radial_tangential_name || model == "equidistant") {
    const std::vector<double> coefficients = section.numbers(coefficients_key);
    section.expectSize(coefficients_key, coefficients, {4});
    setDistortion(camera, model == "equidistant" ? CameraModel::kannala_brandt : CameraModel::pinhole_radial_tangential,
                  coefficients);
  } else if (model != "none") {
    section.failAt("distortion_model", "'distortion_model' must be " + radial_tangential_name +
                                           ", equidistant or none, found '" + model + "'");
  }
  checkCamera(section, camera,
              {"resolution", "resolution", "intrinsics", "intrinsics", "intrinsics", "intrinsics", "distortion_model"});
  return camera;
}

Camera readKalibr(const YamlSection& section) {
  Camera camera = readCalibrationLists(section, "distortion_coeffs", "radtan");
  // [s], from row to row.
  if (section.has("line_delay")) camera.readout_s = readReadout(section, "line_delay", camera.height - 1);
  return camera;
}

}  // namespace

Camera readCalibration(const std::string& path) {
  return readYaml(path, "calibration", [](const YamlSection& section) {
    if (section.has("cam0")) return readKalibr(section.section("cam0"));
    if (section.has("image_width") || section.has("camera_matrix")) return readRos(section);
    if (section.has("sensor_type") || section.has("intrinsics")) {
      return readCalibrationLists(section, "distortion_coefficients", "radial-tangential");
    }
    return readOwn(section);
  });
}

std::string formatCalibrationFile(const Camera& camera) {
  const bool fisheye = camera.model == CameraModel::kannala_brandt;
  std::string text = std::string("model: ") + (fisheye ? "kannala_brandt" : "pinhole_radial_tangential") +
                     "\nwidth: " + std::to_string(camera.width) + "\nheight: " + std::to_string(camera.height) + "\n";
  const auto append = [&text](const char* key, double value) { text += formatted("%s: %.17g\n", key, value); };
  append("fx", camera.fx);
  append("fy", camera.fy);
  append("cx", camera.cx);
  append("cy", camera.cy);
  const std::vector<const char*> names = fisheye ? std::vector<const char*>{"k1", "k2", "k3", "k4"}
                                                 : std::vector<const char*>{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < names.size(); ++i) append(names[i], camera.distortion[i]);
  if (camera.readout_s != 0) append("readout", camera.readout_s);
  return text;
}

}  // namespace edgeslam
