// The scale as it becomes known by itself, from what the configuration names; for the publishing thread.
#pragma once

#include <optional>
#include <string>

#include "scale/gradual_scale.h"
#include "scale/scale_from_camera_height.h"
#include "scale/scale_from_odometry.h"
#include "tracking/frame_result.h"

namespace edgeslam {

class ScaleSearch {
 public:
  // `body_T_camera`: translation [m].
  ScaleSearch(const ScaleOptions& options, const Pose& body_T_camera);

  void add(const FrameResult& result);
  void add(const OdometryPose& pose);
  void add(const GroundPlane& ground);
  // Another map.
  void forget();
  // By a loop: what is known stays published, and is found anew.
  void mapWasCorrected();
  // The camera was in another world: frames before and after do not go together.
  void breakOff();

  // Once a second: the scale from now on; none while it is not known.
  std::optional<ScaleState> everySecond();
  // What is amiss or still waited for, in words; or empty.
  std::string problem() const;

  // Whether a map is wanted now, for groundOf(): each 2 s until the scale is known, then each 10 s.
  bool wantsMap(double seconds) const;
  void mapComes(double seconds) { last_map_s_ = seconds; }

 private:
  std::optional<ScaleEstimate> estimate() const;

  ScaleOptions options_;
  std::optional<ScaleFromOdometry> odometry_;
  std::optional<ScaleFromCameraHeight> height_;
  GradualScale scale_;
  double last_map_s_ = -1e9;
  TrackingState state_ = TrackingState::initialising;
};

}  // namespace edgeslam
