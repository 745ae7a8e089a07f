// What a run finds of its camera that the calibration does not say, or says wrongly.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "geometry/camera.h"
#include "geometry/distortion_reach.h"

namespace edgeslam {

struct FoundCamera {
  std::optional<double> readout_s;  // as Camera::readout_s; none: the calibration's counts
  double focal_scale = 1;           // focal lengths, over those of the calibration
  std::array<double, 2> radial{};   // added to the calibration's first two radial coefficients of distortion, k1 and k2
  std::array<double, 2> principal_point{};  // added to the calibration's cx and cy [px]
};

inline bool operator==(const FoundCamera& a, const FoundCamera& b) {
  return a.readout_s == b.readout_s && a.focal_scale == b.focal_scale && a.radial == b.radial &&
         a.principal_point == b.principal_point;
}
inline bool operator!=(const FoundCamera& a, const FoundCamera& b) { return !(a == b); }

// A calibrated camera, as it was found to be.
inline Camera withFound(Camera camera, const FoundCamera& found) {
  camera.readout_s = found.readout_s.value_or(camera.readout_s);
  camera.fx *= found.focal_scale;
  camera.fy *= found.focal_scale;
  camera.cx += found.principal_point[0];
  camera.cy += found.principal_point[1];
  for (std::size_t k = 0; k < found.radial.size(); ++k) camera.distortion[k] += found.radial[k];
  camera.distortion_reach = distortionReach(camera);
  return camera;
}

}  // namespace edgeslam
