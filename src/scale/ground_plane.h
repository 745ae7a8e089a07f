// The ground that a robot stands on, as a plane through points of the map: how high the camera is above it, in map
// units. Nothing is known of gravity but the camera's place on the robot; so what is taken for the ground must be a
// plane square to the robot's vertical, with points all over it and none below it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "map/map.h"

namespace edgeslam {

struct GroundOptions {
  double largest_tilt_deg = 10;  // of the plane's normal against the cameras' up
  int latest_keyframes = 12;     // whose cameras and points are looked at: the ground around the robot
  int fewest_keyframes = 4;
  int fewest_points = 30;  // on the plane
  int fewest_edges = 8;    // that these are on
};

struct GroundPoint {
  Eigen::Vector3d position;  // world [map units]
  double depth_sigma = 0;    // standard deviation of its distance, as a share of it
  std::size_t camera = 0;    // index of the camera that it is hosted in
  int edge = 0;              // points of one edge share a number
};

struct GroundScene {
  std::vector<Eigen::Vector3d> cameras;  // centres, world [map units]
  std::vector<Eigen::Vector3d> ups;      // of each camera: the robot's vertical, world, unit
  std::vector<GroundPoint> points;
};

// What the latest keyframes saw. `camera_up`: the robot's vertical in the camera's frame, unit.
GroundScene groundScene(const Map& map, const Eigen::Vector3d& camera_up, const GroundOptions& options);

struct GroundPlane {
  Eigen::Vector3d normal;  // unit, world, upwards
  double offset = 0;       // normal * point = offset on the plane [map units]
  double height = 0;       // of the cameras above it, mean [map units]
  double sigma = 0;        // standard deviation of the height, as a share of it
  int points = 0;          // on the plane
  std::string problem;     // why there is no ground to go by; the rest then means nothing. Or empty
};

// RANSAC with the same samples every time, then least squares. Of several planes the lowest is taken.
GroundPlane findGround(const GroundScene& scene, const GroundOptions& options);

}  // namespace edgeslam
