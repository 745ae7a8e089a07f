// Frames, poses and map points, as they go into the library and come out of it.
//
// Frames of reference: the camera's is x right, y down, z forward; the world is the camera's at the map's first
// keyframe. Lengths are in map units: one camera cannot know the scale. With an inertial unit, or by
// the robot's wheels, PosedFrame tells it.
// Rotations are unit quaternions (w, x, y, z).
//
// Worlds: where the camera is lost in a place not seen before, a new map is begun beside the old one. It is a world of
// its own, with its own frame of reference and its own unit, until both are found to be of the same place: the later
// one is then joined to the earlier. Worlds are counted from 0. Poses and points go together only where `world` is the
// same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace edgeslam {

// An image of 8 bits a pixel, row by row from the top. It is looked at during the call only.
struct GreyImage {
  const std::uint8_t* pixels = nullptr;
  int width = 0;   // [px], the calibration's
  int height = 0;  // [px]
  std::ptrdiff_t bytes_per_row = 0;
};

// What an inertial unit measured, which is fixed to the camera; the configuration's section `imu` says how.
struct InertialMeasurement {
  std::int64_t time_ns = 0;                       // of the unit's clock: imu.time_offset_s after the frames'
  std::array<double, 3> rotation_rate{0, 0, 0};   // the unit's axes [rad/s]
  std::array<double, 3> specific_force{0, 0, 0};  // the unit's axes [m/s^2]: at rest 9.81 upwards
};

// Where the wheels say that the robot's body is; the configuration's camera.body_T_camera says where the camera is on
// it.
struct WheelMeasurement {
  std::int64_t time_ns = 0;                       // of the frames' clock
  std::array<double, 3> position{0, 0, 0};        // in a frame that may drift but not jump, x and y in the floor [m]
  std::array<double, 4> orientation{1, 0, 0, 0};  // w, x, y, z
};

// Of the world T camera: takes coordinates in the camera frame to the world.
struct CameraPose {
  std::array<double, 3> position{0, 0, 0};        // of the camera, world [map units]
  std::array<double, 4> orientation{1, 0, 0, 0};  // w, x, y, z
};

enum class SlamState {
  initialising,  // no map yet
  tracking,      // a measured pose
  predicted,     // a pose from motion alone: not to be steered by
  recovered,     // measured again after a loss
  relocalised,   // likewise, found again in the whole map
  lost           // no pose
};

struct PosedFrame {
  std::int64_t index = 0;    // of the frame, from 0
  std::int64_t time_ns = 0;  // as it was given with the frame
  SlamState state = SlamState::initialising;
  std::string reason;  // why it is not plainly `tracking`; empty otherwise
  bool has_pose = false;
  int world = -1;  // that the pose is in; -1: there is none
  CameraPose pose;
  // Of a small motion [translation; rotation vector [rad]] of the camera in its own frame, row by row.
  std::array<double, 36> covariance{};
  // Where the camera is in a frame that never jumps: it begins at the first measured pose and goes on by motion alone,
  // through corrections of the map and short gaps; it drifts. Where `odometry_resets` is higher than before, the motion
  // in between is not known.
  bool has_odometry = false;
  CameraPose odometry;                           // map units
  std::array<double, 36> odometry_covariance{};  // as `covariance`, since the first pose
  int odometry_resets = 0;
  // Where an inertial unit tells it: what a map unit is, and where down is, in this world. Both become known some
  // seconds after a map's start, and better from then on. Wheels tell what a map unit is, but not where down is.
  bool is_metric = false;
  double metres_per_unit = 1;
  double scale_sigma = 0;               // standard deviation of it, share of it
  std::array<double, 3> down{0, 0, 0};  // world, unit; zero where it is not known
  int tracked_points = 0;               // points followed in the image
  int mapped_points = 0;                // of these with depth, and used for the pose
  double latency_ms = -1;               // from handing the frame over to its pose; negative: not known

  // The pose was measured, not guessed.
  bool isGood() const {
    return state == SlamState::tracking || state == SlamState::recovered || state == SlamState::relocalised;
  }
};

struct TimedCameraPose {
  std::int64_t time_ns = 0;
  CameraPose pose;
  int world = 0;  // that the pose is in
};

// A point on an image edge.
struct MapEdgePoint {
  std::int64_t id = 0;
  std::array<float, 3> position{};        // world [map units]
  std::array<float, 3> edge_direction{};  // world, unit; zero for a corner-like point
  float depth_sigma_share = 0;            // standard deviation of its depth over the depth
  std::uint8_t grey = 0;                  // of the image there
  int world = 0;                          // that it is in
};

}  // namespace edgeslam
