#include "calibration/calibration_text.h"

#include <vector>

#include "edgeslam/input_error.h"
#include "files/format_text.h"

namespace edgeslam {
namespace {

struct Parameter {
  std::string name;
  double value = 0, sigma = 0;
  bool in_pixels = false;
};

std::vector<Parameter> parametersOf(const Calibration& calibration) {
  const Camera& c = calibration.camera;
  const CameraVector& sigma = calibration.sigma;
  std::vector<Parameter> parameters{{"fx", c.fx, sigma(0), true},
                                    {"fy", c.fy, sigma(1), true},
                                    {"cx", c.cx, sigma(2), true},
                                    {"cy", c.cy, sigma(3), true}};
  const bool fisheye = c.model == CameraModel::kannala_brandt;
  const std::vector<const char*> names = fisheye ? std::vector<const char*>{"k1", "k2", "k3", "k4"}
                                                 : std::vector<const char*>{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    parameters.push_back({names[i], c.distortion[i], sigma(4 + static_cast<Eigen::Index>(i)), false});
  }
  return parameters;
}

const char* modelName(const Camera& camera) {
  return camera.model == CameraModel::kannala_brandt ? "kannala_brandt" : "pinhole_radial_tangential";
}

// Control characters would end a comment.
}  // namespace

std::string calibrationFileText(const Calibration& calibration, const Board& board, const std::string& source) {
  const Camera& camera = calibration.camera;
  std::string text =
      "# made by edgeslam calibrate with " + boardText(board) + " from " + InputError::oneLine(source) + "\n";
  text += formatted("# %d views, reprojection error %.3f px; %d views held back: %.3f px\n", calibration.views,
                    calibration.rms_px, calibration.held_back_views, calibration.held_back_rms_px);
  text += std::string("model: ") + modelName(camera) + "\nwidth: " + std::to_string(camera.width) +
          "  # [px]\nheight: " + std::to_string(camera.height) + "\n";
  for (const Parameter& p : parametersOf(calibration)) {
    if (p.in_pixels) {
      text += formatted("%s: %.4f  # [px], standard deviation %.4f\n", p.name.c_str(), p.value, p.sigma);
    } else if (p.sigma > 0) {
      text += formatted("%s: %.8f  # standard deviation %.8f\n", p.name.c_str(), p.value, p.sigma);
    } else {
      text += p.name + ": 0  # not significant\n";
    }
  }
  return text;
}

std::string calibrationSummary(const Calibration& calibration, const ViewCoverage& coverage) {
  const Camera& camera = calibration.camera;
  std::string text = formatted("%d x %d px, %s\n", camera.width, camera.height, modelName(camera));
  for (const Parameter& p : parametersOf(calibration)) {
    if (p.in_pixels) {
      text += formatted("  %s %11.3f px +- %.3f\n", p.name.c_str(), p.value, p.sigma);
    } else if (p.sigma > 0) {
      text += formatted("  %s %11.6f    +- %.6f\n", p.name.c_str(), p.value, p.sigma);
    }
  }
  text += formatted("  %d views with %d corners, reprojection error %.3f px\n", calibration.views, calibration.corners,
                    calibration.rms_px);
  text += formatted("  check: %d views held back from a fit without them, reprojection error %.3f px\n",
                    calibration.held_back_views, calibration.held_back_rms_px);
  text += formatted("  standard deviation of a pixel's direction: %.3f px over the image, %.3f px at its worst place\n",
                    calibration.expected_rms_px, calibration.expected_max_px);
  for (const std::string& remark : calibration.remarks) text += "  " + remark + "\n";
  text +=
      formatted("  board corners in %.0f %% of the image ('.' none, '+' some, '#' many):\n", 100 * coverage.share());
  for (const std::string& line : coverageMap(coverage)) text += "    " + line + "\n";
  return text;
}

}  // namespace edgeslam
