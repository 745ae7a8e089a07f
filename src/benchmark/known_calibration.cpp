#include "benchmark/known_calibration.h"

#include <regex>

#include "report/report_published.h"

namespace edgeslam {
namespace {

Camera pinhole(double fx, double fy, double cx, double cy, const std::array<double, 5>& distortion) {
  Camera camera;
  camera.width = 640, camera.height = 480;
  camera.fx = fx, camera.fy = fy, camera.cx = cx, camera.cy = cy;
  camera.distortion = distortion;
  return camera;
}

bool isOfIclNuim(const std::string& name) {
  const std::regex living_room(
      "(icl[_-])?(nuim[_-])?(lr|living_?room)[_-]?(traj|kt)?[_-]?[0-3]([_-]?frei[_-]png|[_-]?loop|n)*");
  const std::regex office("office[0-3]");  // whatever else an office is called was made into this
  return std::regex_match(name, living_room) || std::regex_match(name, office);
}

}  // namespace

std::optional<Camera> knownCalibration(const std::string& sequence) {
  const std::string name = shortSequenceName(sequence);
  if (name.rfind("fr1_", 0) == 0)
    return pinhole(517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633});
  if (name.rfind("fr2_", 0) == 0)
    return pinhole(520.9, 521.0, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172});
  if (name.rfind("fr3_", 0) == 0) return pinhole(535.4, 539.2, 320.1, 247.6, {0, 0, 0, 0, 0});
  if (isOfIclNuim(name)) return pinhole(481.2, 480.0, 319.5, 239.5, {0, 0, 0, 0, 0});
  return std::nullopt;
}

}  // namespace edgeslam
