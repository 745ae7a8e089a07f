// What a live run gives out, to whom, and what those who look on and the robot may ask of it.
#pragma once

#include <string>

#include "configuration/configuration.h"
#include "drivers/lcm/lcm_options.h"
#include "drivers/ros2/ros2_options.h"
#include "drivers/viewer/viewer.h"
#include "geometry/camera.h"
#include "scale/scale_options.h"

namespace edgeslam {

struct PublishingSetup {
  LcmOptions lcm;
  Ros2Options ros2;
  double map_interval_s = 5;  // the map is sent at most so often where it changed; 0: on request only
  Pose body_T_camera;         // translation [m]
  Camera camera;
  ScaleOptions scale;
  std::string map_file;  // empty: no command saves the map
  bool map_is_frozen = false;
  Viewer* viewer = nullptr;  // null: nobody can look on; must outlive the publisher
  bool begins_anew = false;  // capture carries out commands that begin another run: reset, start of a recording
};

// With all that the configuration says of it.
PublishingSetup publishingSetup(const Configuration& configuration, const Camera& camera);

}  // namespace edgeslam
