// The metric scale from the camera's known height over the ground: metres over the height in map units.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "geometry/scale_estimate.h"
#include "scale/ground_plane.h"
#include "scale/scale_options.h"

namespace edgeslam {

// Of the ground around the latest keyframes. A pure function of the map, some ms of work: for a thread in the
// background. `body_T_camera`: the body's z axis is up.
GroundPlane groundOf(const Map& map, const Pose& body_T_camera, const CameraHeightOptions& options);

class ScaleFromCameraHeight {
 public:
  explicit ScaleFromCameraHeight(const CameraHeightOptions& options) : options_(options) {}

  // Once for each look at a map that has grown since the one before. One without a ground takes the oldest one back.
  void add(const GroundPlane& ground);
  // Another map, or a corrected one.
  void clear();

  // None while the ground was not seen often enough. Looks share keyframes and points: nothing averages out.
  std::optional<ScaleEstimate> estimate() const;
  // What is amiss or still waited for, in words; or empty.
  std::string problem() const;

  static constexpr std::size_t fewest_looks = 3, most_looks = 8;

 private:
  CameraHeightOptions options_;
  std::deque<ScaleMeasurement> looks_;
  std::string refused_ = "no ground looked for yet";
};

}  // namespace edgeslam
