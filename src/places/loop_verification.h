// P26: is a candidate the same place? 3D-3D correspondences, a similarity by Horn's method in RANSAC, refined on
// reprojection errors, and enough points that agree; then a guided search that every loop must pass, and which in bare
// scenes does without descriptors. A wrong loop is worse than none: every doubt refuses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "edges/edge_detection.h"
#include "edges/image_reading.h"
#include "places/guided_matching.h"
#include "places/guided_search.h"
#include "places/keyframe_matching.h"

namespace edgeslam {

// Bounds of a loop's guided search: what the loop's old side shows is only a part of what is in view by now.
inline GuidedSearchOptions boundsOfLoops() {
  GuidedSearchOptions search;
  search.bare_inlier_share = 0.5;
  search.bare_corner_share = 0.4;
  search.explained_share = 0.3;
  return search;
}

// Options of the guided search that every loop must pass (places/loop_search.h).
struct LoopSearchOptions {
  GuidedSearchOptions search = boundsOfLoops();
  double least_correlation = 0.3;     // of the thumbnails, for starts by their turn
  double screened_share = 0.25;       // of the points in view that must agree roughly at the first look
  double found_and_explained = 0.95;  // least sum of the shares of the points found and of the edges explained
  // Two maps that are bent fit each other in a part only. A pose by so much less may be right: others must say the
  // same.
  double near_share = 0.25;          // of the points in view,
  int near_corners = 20;             // with so many corners: up to that many agree where a place only looks alike
  double near_agreeing_share = 0.4;  // of the pairs that must agree on the scale then
  int fewest_rough_inliers = 8;      // of the descriptors, for a start by their similarity
  int refined_poses = 3;             // most poses that are followed up from there
  int scale_neighbours = 4;          // keyframes whose points join those of the current one
  double pair_across = 2;         // points of both sides so near in the image are one piece of edge: across it [px] ...
  double pair_along = 6;          // ... in all [px] ...
  double pair_dot = 0.9;          // ... and with its normal, dot product
  double depth_deviation = 0.05;  // of both maps' shapes, share of the distance
  int fewest_pairs = 20;
  double agreeing_share = 0.6;     // of the pairs that must agree on the scale
  double scale_deviation = 0.03;   // largest standard error of its logarithm
  int witnesses = 4;               // keyframes before the current one that are located too ...
  int fewest_witnesses = 2;        // ... of which so many must be found, and none elsewhere:
  int descriptors_count = 2;       // ... and descriptors that are enough by themselves are so many;
  double witness_turn_deg = 2;     // [deg]
  double witness_distance = 0.05;  // share of the scene's distance
  double witness_scale = 0.05;     // of the scale's logarithm
};

struct LoopVerificationOptions {
  KeyframeMatchingOptions matching;
  GuidedMatchingOptions guided;
  int neighbours = 4;  // keyframes whose points join those of each of the two
  int ransac_iterations = 400;
  int fewest_descriptor_inliers = 15;  // before patches are looked for
  double outlier = 3.0;                // whitened error of an inlier, in either image and in depth
  double map_error = 0.7;              // of the maps' shapes, added to each measurement's deviations [px]
  double largest_move = 4;             // of a patch from where it should be, the last time it is looked for [px]
  double depth_error = 0.05;           // likewise to the distances, as a share of them
  int most_needed_inliers = 100;       // the paper's count ...
  int fewest_needed_inliers = 40;      // ... less in a poor scene, never less than this ...
  double needed_share = 0.5;           // ... but this share of the points that both sides have mapped
  double least_found_share = 0.4;      // of the points that should be visible, this share must be found and agree
  int fewest_cells = 5;                // of the image's 16 parts, so many must hold inliers
  double largest_scale = 2;            // of the similarity, or its inverse
  LoopSearchOptions search;
};

struct LoopVerification {
  bool accepted = false;
  bool accepted_by_descriptors = false;  // and by patches, but not by the search, as it may be: similarity, found
  bool nearly_found = false;             // by the search, and not accepted by anything: similarity, found, inliers
  std::string reason;                    // why not, or what speaks for it, in words
  Similarity current_S_candidate;        // camera coordinates of the candidate to those of the current keyframe
  int descriptor_pairs = 0, descriptor_inliers = 0;
  int inliers = 0, needed_inliers = 0;
  double found_share = 0;
  int corner_inliers = 0;  // of the inliers of the search
  // Points of the candidate's side found in the current keyframe that agree with the similarity.
  struct Found {
    PointId candidate_point = 0;
    PointId current_point = -1;  // its counterpart on the current side, or -1
    Measurement measurement;     // in the current keyframe
  };
  std::vector<Found> found;
};

// Whether the candidate shows the same place as the current keyframe; both must be in the map. Same seed, same result.
LoopVerification verifyLoop(const Camera& camera, const ImageReading& reading, const Map& map, KeyframeId current,
                            KeyframeId candidate, const LoopVerificationOptions& options, std::uint64_t seed);

}  // namespace edgeslam
