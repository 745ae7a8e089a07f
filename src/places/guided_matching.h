// P26, second half: once a similarity between two views of a place is known, the points of the one are looked for where
// it says in the image of the other, by their warped patch and damped along their edge. Points of plain edges, which no
// descriptor tells apart, count from here on.
#pragma once

#include <vector>

#include "places/place_view.h"

namespace edgeslam {

struct GuidedMatchingOptions {
  int window = 11;                     // side of the patch [px]
  int iterations = 10;                 // steps of the alignment
  double damping = 3;                  // Levenberg term towards the prediction [grey^2/px^2]
  double least_correlation = 0.8;      // normalized cross-correlation of the patch
  double largest_view_angle_deg = 50;  // between the rays from which a point is seen [deg]
  double partner_across = 2;           // a map point of the other side is the same one if so near across the edge ...
  double partner_along = 10;           // ... and along it [px]
};

struct GuidedMatch {
  int from = -1;            // index into the points of the view that was looked for
  int to = -1;              // index into the points of the other view: the same piece of edge, mapped there; or -1
  Measurement measurement;  // where it was found in the image of the other view
};

struct GuidedMatches {
  std::vector<GuidedMatch> matches;
  int visible = 0;          // points that should be seen in the image
  int visible_in_both = 0;  // of these, those with a map point of the other side where they should be
};

// Looks for the points of `from` in the image of `to`; `to_S_from` takes camera coordinates of the one to the other. A
// point that moves farther than `largest_move` [px] across its edge from where it is predicted is not believed. Empty
// where `to` has no images.
GuidedMatches matchGuided(const Camera& camera, const Map& map, const PlaceView& from, const PlaceView& to,
                          const Similarity& to_S_from, double largest_move, const GuidedMatchingOptions& options);

// Finds one point of `from` by its patch in `images`, seen from the camera that `camera_T_from` gives up to scale. True
// where it was found; `predicted` becomes what was measured.
bool findByPatch(const Camera& camera, const Map& map, const PlaceView& from, const PlacePoint& point,
                 const Pose& camera_T_from, const FrameImages& images, double largest_move,
                 const GuidedMatchingOptions& options, Measurement& predicted);

}  // namespace edgeslam
