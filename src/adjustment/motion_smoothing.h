// Poses of frames in a row, from what is measured in each of them and from how a camera moves: its speed changes little
// from one frame to the next (white noise on the acceleration: Anderson and Barfoot, Full STEAM Ahead, 2015). Where
// measurements tell a direction well, that adds next to nothing; where they leave it open, poses err from frame to
// frame as no camera moves.
#pragma once

#include <functional>
#include <vector>

#include "adjustment/pose_adjustment.h"

namespace edgeslam {

// How much the speed changes: standard deviation of each component after a second, growing with the root of the time.
struct SpeedWalk {
  double position = 0;  // [map unit / s]
  double rotation = 0;  // [rad / s]
};

struct SmoothedFrame {
  double time_s = 0;
  Pose world_T_camera;
  SpeedWalk walk;         // over 0
  bool is_fixed = false;  // its pose is known
};

// What is measured in a frame, by its place, says of a pose.
using FrameEquations = std::function<PoseEquations(std::size_t frame, const Pose& world_T_camera)>;

// `frames`: in the order of time, which differs from one to the next. Those that are not fixed get the poses of least
// cost, in place. Levenberg's steps, with one block of six unknowns a frame, each tied to the two before and after it.
void smoothMotion(const FrameEquations& equations, int most_iterations, std::vector<SmoothedFrame>& frames);

// How the speed changes over three frames in a row, against how much it may.
struct SpeedChange {
  Vector6d residual;     // [position, world axes; rotation], whitened by the middle frame's walk
  Matrix6d by_frame[3];  // its derivatives by the right-hand updates of the three poses
};
SpeedChange speedChange(const SmoothedFrame& before, const SmoothedFrame& at, const SmoothedFrame& after);

}  // namespace edgeslam
