// The pixel of each track is refined against its patch in a keyframe, warped as the poses say, so that it does not
// drift from frame to frame; what no longer looks like its keyframe's patch is dropped (design, section 5: flow).
#pragma once

#include <vector>

#include "flow/patch_alignment.h"
#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/track.h"

namespace edgeslam {

struct RefinementOptions {
  bool enabled = true;
  int window = 11;  // side of the patch [px]
  int iterations = 8;
  double damping = 3;              // Levenberg term towards the flow's result [grey^2/px^2]
  double least_correlation = 0.7;  // normalized cross-correlation below which the track is dropped
  double largest_move = 2.0;       // a refinement that moves the point farther across its edge is not believed [px]
};

// From a keyframe to a frame: the pose, and how both cameras moved as they were read.
struct KeyframeToCamera {
  KeyframeToCamera(const Pose& pose, const Twist& of_keyframe = Twist::Zero(), const Twist& of_camera = Twist::Zero())
      : camera_T_keyframe(pose), keyframe_twist(of_keyframe), camera_twist(of_camera) {}

  Pose camera_T_keyframe;
  Twist keyframe_twist, camera_twist;
};

// 2x2: takes offsets in the current image to offsets in the keyframe's, for a small patch that faces the keyframe at
// the given distance from it.
Eigen::Matrix2f keyframeWarp(const Camera& camera, const KeyframeToCamera& motion,
                             const Eigen::Vector2f& keyframe_pixel, double depth);

// Refines the tracks in place and removes those that fail.
void refineTracks(const Camera& camera, const MapView& view, const FrameImages& images, const MovingCamera& moving,
                  double scene_depth, const RefinementOptions& options, std::vector<Track>& tracks);

}  // namespace edgeslam
