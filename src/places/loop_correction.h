// P27: what a verified loop does to the map: drift is shared out over the keyframes, points go along with their hosts,
// and points of the old side are seen again by the new one, which holds both sides together in every adjustment to
// come.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "map/worlds.h"
#include "places/loop_verification.h"

namespace edgeslam {

struct LoopCorrectionOptions {
  int covisible_points = 30;      // shared points that make an edge of the pose graph ...
  double covisible_share = 0.15;  // ... and this share of the most that any keyframe shares: few may be wrong ones
  double loop_weight = 10;        // of the loop against that of an edge between covisible keyframes
  int iterations = 30;            // of the pose graph
  int neighbours = 4;             // of the current keyframe in which the old side's points are looked for too
  double largest_move = 4;        // a point found farther across its edge from where it should be is not taken [px]
};

// A value that mapping applies to the map that it was made from, grown since or not.
struct LoopCorrection {
  struct Observation {
    KeyframeId keyframe = -1;
    PointObservation observation;  // of a point of the old side
  };
  KeyframeId current = -1, candidate = -1;
  // Two worlds are one: all that is done but for the observations. Otherwise:
  std::optional<WorldJoin> join;
  // Moves a keyframe of the loop's world and the points that it hosts; one made since moves as the one before it.
  std::map<KeyframeId, Similarity> new_world_S_world;
  int world = 0;
  std::vector<Observation> observations;  // by keyframe, then point
};

// Where a loop leads from one world to another: the younger one becomes part of the older. As the loop says, whatever
// is known of their frames.
WorldJoin joinOf(const Map& map, KeyframeId current, KeyframeId candidate, const Similarity& current_S_candidate);

// False where the pose graph failed: then the correction is empty.
bool computeCorrection(const Camera& camera, const Map& map, KeyframeId current, KeyframeId candidate,
                       const LoopVerification& loop, const LoopVerificationOptions& verification,
                       const LoopCorrectionOptions& options, LoopCorrection& correction);

// Moves the keyframes and their points, and adds the observations. Keyframes that are newer than the correction go
// along with its last one. Points and keyframes that are no longer there are passed over.
void applyCorrection(const LoopCorrection& correction, Map& map);

}  // namespace edgeslam
