// Orientation only: after a turn on the spot or a fast pan hardly any of the map is in view, and what is tracked has no
// depth yet. A point without depth is as good as infinitely far until parallax says otherwise: all tracks together tell
// how the camera turned, while its position is held, with what a camera may have moved meanwhile (Li et al. 2023,
// RD-VIO, defers triangulation likewise). The points chosen on the way get their depth once the camera moves again, so
// that the map grows on in the same world. Its scale is known from there on only as well as the position was: the
// covariance says so.
#pragma once

#include <memory_resource>
#include <optional>
#include <vector>

#include "tracking/pose_estimation.h"

namespace edgeslam {

struct OrientationOnlyOptions {
  bool enabled = true;
  double speed = 0.5;                 // of the camera, standard deviation [distances of the scene/s]
  double longest_gap_s = 0.15;        // since the camera was located: later it may be anywhere, and is looked for
  int fewest_tracks = 30;             // that are followed into the frame ...
  double least_followed_share = 0.2;  // ... of the last frame's: with fewer it is another place
  double least_share = 0.7;           // of all tracks that turn with the camera, within what its motion may move them
  double least_map_share = 0.5;       // of the map points in view that agree
  double largest_position_deviation = 0.3;   // the position is held no longer: share of the scene's distance
  double largest_rotation_deviation = 0.05;  // [rad]
};

// What is known of the camera before the frame.
struct HeldCamera {
  Pose world_T_last;                       // when it was located last ...
  Matrix6d covariance = Matrix6d::Zero();  // ... of the right-hand update [translation; rotation] ...
  double seconds_ago = 0;                  // ... so long ago
  double followed_share = 1;               // of its tracks, into the frame
  Eigen::Quaterniond world_R_camera = Eigen::Quaterniond::Identity();  // now, as the images as a whole tell
  double scene_depth = 1;                                              // [map units]
};

// The pose that the tracks and the held position give together; nothing where they contradict each other, or say too
// little. Inliers are of the map points.
std::optional<FramePose> orientationOnly(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                                         const HeldCamera& held, const FramePoseOptions& pose_options,
                                         const OrientationOnlyOptions& options, std::pmr::memory_resource* memory,
                                         const RowMotion& motion = {});

}  // namespace edgeslam
