// How the metric scale becomes known, as the configuration says it.
#pragma once

#include <string>

namespace edgeslam {

// Of the wheels, as pose_t messages.
struct OdometryOptions {
  std::string channel;
  double sigma = 0.02;            // standard deviation of its own scale (the wheels' size), as a share of it
  double sigma_per_metre = 0.03;  // of a way of 1 m, by slip [m]; grows with the root of the way
  double window_m = 0.5;          // way of the body from one comparison to the next
};

struct CameraHeightOptions {
  double camera_height_m = 0;    // of the camera's centre over the ground; 0: not given
  double sigma_m = 0.01;         // standard deviation of it
  double largest_tilt_deg = 10;  // of the ground's normal against the body's z axis
};

struct ScaleOptions {
  // "none": on command only; "camera_height", "odometry"
  std::string source = "none";
  double largest_sigma = 0.1;  // a scale that is known worse than this share is refused
  // Of the map that is continued at the start; 0: not known.
  double metres_per_unit = 0;
  double sigma = 0.05;  // standard deviation of that scale over the scale
  CameraHeightOptions height;
  OdometryOptions odometry;
};

}  // namespace edgeslam
