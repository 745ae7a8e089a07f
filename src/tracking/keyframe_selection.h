// Keyframe selection, section 3.2 of the paper: P8 to P12.
#pragma once

#include "tracking/track.h"

namespace edgeslam {

struct KeyframeOptions {
  // P8: rotation to the last keyframe [deg]. Unlike the paper's, it is the current frame that becomes one: the camera
  // was located in it, and need not be located in it anew.
  double rotation_deg = 15;
  // Where the scene is bare: fewer map points than `fewest_mapped`, and this share of the tracks on straight edges.
  // There few lines have to tell everything, and several keyframes must have seen each before it leaves the image.
  double bare_rotation_deg = 7;
  double bare_share = 0.25;
  double track_share = 0.6;   // P9: correspondences left, as a share of the running average, which falls with them
  int fewest_mapped = 250;    // P10: 3D-2D correspondences ...
  double mapped_share = 0.6;  // ... or this share of the most since the last keyframe, if less: bare scenes stay calm
  double displacement_share = 0.2;  // P11: mean displacement, as a share of the image's width
  double interval_s = 0.5;          // P12 (the paper: 1 s) ...
  // ... if the image moved by this share of its width, rotation included: a camera that stands still learns nothing
  // from another keyframe, and would lose those that it knows its place by.
  double least_displacement_share = 0.005;
  // No two keyframes nearer than this: every third frame at 30 frames/s, a little less than their distance, as time
  // stamps jitter.
  double least_interval_s = 0.09;
};

// What the criteria look at.
struct KeyframeEvidence {
  double rotation_deg = 0;  // since the last keyframe
  double mean_displacement_px = 0;
  int tracks = 0;              // correspondences with the last keyframe
  int on_straight_edges = 0;   // those of them that were on straight edges there
  double average_tracks = 0;   // running average of these over the frames
  int mapped = 0;              // 3D-2D correspondences
  int mapped_at_keyframe = 0;  // the most there were since the last keyframe
  double seconds = 0;          // since the last keyframe
  bool too_soon = false;       // after the last keyframe
};

enum class KeyframeChoice { none, previous_frame, current_frame };

struct KeyframeDecision {
  KeyframeChoice choice = KeyframeChoice::none;
  const char* reason = "";
};

KeyframeDecision selectKeyframe(const KeyframeEvidence& evidence, int image_width, const KeyframeOptions& options);

}  // namespace edgeslam
