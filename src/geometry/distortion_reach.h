// How far from the axis a lens's distortion can be believed. Its polynomial follows the points that it was fitted to.
// Farther out its highest coefficient has the say, and where that is negative the polynomial comes to rest and turns
// back: the image is folded. Pixels beyond are the image of nothing, and points at the side of the camera seem to be
// in view.
#pragma once

#include "geometry/camera.h"

namespace edgeslam {

// Distance from the centre of the image's farthest corner, as it is seen: in focal lengths.
double farthestCorner(const Camera& camera);

// Camera::distortion_reach by the radial coefficients: infinity where the polynomial can be believed everywhere. It
// cannot where directions far out lie together at less than half the distance that they have in the centre: no lens
// does that.
double distortionReach(const Camera& camera);

// Distance from the centre, as it is seen, of what lies at the distortion's reach: in focal lengths.
double seenAtReach(const Camera& camera);

// True where the distortion can be believed over the whole image.
bool reachesCorners(const Camera& camera);

// The camera itself where its distortion reaches the corners. Where it does not, the last radial coefficients are left
// out, as few as that takes, and those before them fitted to what can be believed: the ones that turn the polynomial
// back owe their value to points that were not there. Where not even one coefficient reaches the corners, it is the
// camera itself: its lens distorts so much that its own polynomial with its tangent says more.
Camera withBelievableDistortion(const Camera& camera);

// What the distance from the axis becomes beyond `camera.distortion_reach`: offset + slope * distance. The polynomial
// goes on along its tangent, so that every direction has one pixel, and every pixel one direction.
struct DistortionTangent {
  double offset = 0, slope = 1;
};
DistortionTangent distortionTangent(const Camera& camera);

}  // namespace edgeslam
