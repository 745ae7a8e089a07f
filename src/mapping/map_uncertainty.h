// Beyond the paper: how far the map itself may have drifted. Tracking knows its pose in the map far better than the map
// knows where it is: each keyframe was found from those before it. A keyframe's uncertainty is that of the best of the
// keyframes that it shares points with, carried over to it, and what these points leave open between the two; so a
// keyframe that sees old points again is as certain as they are. Wheels tie it to the keyframe before where points do
// not.
#pragma once

#include <optional>

#include "geometry/camera.h"
#include "map/map.h"
#include "wheels/wheel_motion.h"

namespace edgeslam {

struct MapUncertaintyOptions {
  int neighbours = 8;      // most that are tried, those that share most points
  int fewest_points = 12;  // that two keyframes must share to be known relative to each other
  // Measurements of a point are not independent, nor of its neighbours on an edge: what they say of standard deviations
  // is too little by these factors.
  double pose_factor = 4;
  double scale_factor = 4;
  // Those on one straight edge go together altogether: so many of them tell what all of them do.
  double independent_on_edge = 2;
  // What a way adds whatever is seen on it, for calibration and rolling shutters are never quite right: standard
  // deviations after a way as long as the scene is deep, or a turn of 1 rad, growing with the root of the way.
  double position_walk = 0.004;   // share of the scene's depth
  double rotation_walk = 0.0075;  // [rad]
  double scale_walk = 0.015;
  // A view is narrow below this tangent of half its angle, along the image's longer side: a turn then looks like a
  // motion to the side.
  double narrow_view = 0.61;
  std::optional<WheelOptions> wheels;  // beneath the camera; none: the camera alone
};

// Gives the latest keyframe its uncertainty, from the others'.
void addUncertainty(const Camera& camera, const MapUncertaintyOptions& options, Map& map);

// Gives every keyframe its uncertainty anew: after a loop was closed, or where the map was read from a file. A world's
// first keyframe is its origin and its scale the map's unit, so that its own is 0.
void renewUncertainty(const Camera& camera, const MapUncertaintyOptions& options, Map& map);

}  // namespace edgeslam
