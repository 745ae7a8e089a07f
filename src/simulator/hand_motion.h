// How the simulator's camera moves: a smooth path for each scene, the tremor of a hand upon it, and faults put in on
// purpose.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/pose.h"
#include "simulator/scene.h"

namespace edgeslam {

struct TimeSpan {
  double begin_s = 0, end_s = 0;
};

// amplitude * sin(2 pi frequency t + phase)
struct Sway {
  double amplitude = 0;  // [m] or [rad]
  double frequency_hz = 0;
  double phase = 0;  // [rad]
};

struct CameraMotion {
  SceneKind scene = SceneKind::panels;
  double speed = 1;                         // 1: the scene's usual speed
  std::array<std::vector<Sway>, 6> tremor;  // camera frame: x, y, z [m], then rotation vector [rad]
  std::array<std::vector<Sway>, 6> shake;   // the same, while the camera is shaken
  std::vector<TimeSpan> shaken;
  std::vector<TimeSpan> still;               // the camera does not move at all; it brakes and starts just outside
  std::vector<TimeSpan> turned;              // it turns on the spot, to the side and back; it stands still then, too
  double turn_rad = 0;                       // so far
  double path_phase = 0;                     // [rad], where on its path the camera starts
  std::vector<double> corridor_distances_m;  // corridor: way gone, every corridor_step_s
};

CameraMotion makeCameraMotion(SceneKind scene, double speed, std::uint64_t seed, double duration_s);

// Camera pose at a time from the start, continuous with continuous velocity. The same motion and time give the same
// pose.
Pose poseAt(const CameraMotion& motion, double time_s);

// Time in which the path comes back to its start: the corridor's lap, the room's turn, the panels' way there and back.
double lapTime(const CameraMotion& motion);

}  // namespace edgeslam
