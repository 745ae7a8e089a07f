// What is believed: a frame's pose counts as measured only where enough of the map agrees with it, and where what
// agrees says enough.
#pragma once

#include <cstddef>

#include "tracking/pose_estimation.h"

namespace edgeslam {

struct AcceptanceOptions {
  double least_inlier_share = 0.35;  // of the map points in view: fewer, and the pose is not believed ...
  double least_points_share = 0.15;  // ... nor with fewer than this share of the points of the pose before ...
  double largest_deviation = 0.03;   // ... nor where it is less certain: share of the scene's depth, or angle [rad]
  // The first pose after a loss or blur, or after the camera was found again, needs a good part of the points that the
  // last good pose had, or that it was found by ...
  double regain_points_share = 0.7;
  // ... or fewer of them, where these are most of the map points in view.
  double regain_fewest_points_share = 0.3;
  double regain_inlier_share = 0.6;
  int fewest_points = 0;  // nor with fewer than so many
  // A pose off the motion that was expected by what takes such a change of speed (distances of the scene/s, or rad/s)
  // is a leap. A hand can jerk the camera, but then what was tracked is still in view; with fewer of the tracks
  // followed the camera may have been carried off to a place that looks alike.
  double leap_speed = 4.5;
  double leap_followed_share = 0.6;
};

// What a pose is judged against.
struct AcceptanceContext {
  int inliers_before = 0;     // of the last frame that was located; of one found by others: its map points
  bool regains = false;       // it is blurred or lost, or the frame before was, or was found again by others
  bool knows_motion = false;  // the two frames before were located in this map, so that a motion is expected
  double scene_depth = 1;     // [map units]
  double seconds = 0;         // since the last frame that was located
  Pose world_T_predicted;     // by the motion before
  double followed_share = 1;  // of the last frame's tracks, into this one
};

// With fewer of the map points in view a pose is not believed.
int fewestInliers(std::size_t in_view, const AcceptanceContext& context, const AcceptanceOptions& options);

bool isLeap(const FramePose& pose, const AcceptanceContext& context, const AcceptanceOptions& options);

// Of a pose in a map that stands.
bool isBelieved(const FramePose& pose, const AcceptanceContext& context, const AcceptanceOptions& options);

}  // namespace edgeslam
