// P24, P25: which earlier keyframes look enough like the current one to be verified as a loop.
#pragma once

#include <vector>

#include "map/map.h"

namespace edgeslam {

struct LoopDetectionOptions {
  int bar_keyframes = 5;         // P24: at most so many previous keyframes set the bar ...
  double bar_rotation_deg = 30;  // ... of those that look less than this another way [deg]
  int recent_keyframes = 10;     // so many keyframes before the current one are no candidates
  double held_share = 0.15;      // a keyframe that shares this share of the most that any does is held in place by it
  int consecutive = 3;           // P25: keyframes in a row that must be over the bar
  int most_candidates = 3;       // the best so many are offered
};

struct LoopCandidate {
  KeyframeId keyframe = -1;
  double score = 0;
};

struct LoopDetection {
  double bar = 0;                         // 1 where no previous keyframe could set it
  std::vector<LoopCandidate> candidates;  // best first
};

// Score of a keyframe that cannot be compared: it has no images, or is culled.
constexpr double no_score = -1;

// `scores`: likeness of each earlier keyframe to `current`, in [0, 1], by keyframe number, or no_score where it cannot
// be compared or is culled. A keyframe is a candidate where it is not recent, is not held together with the current one
// by map points (see mayCloseLoop), or is of another world, and it and its neighbours in the order of the keyframes,
// `consecutive` in a row, are all over the bar; it is the best among these. Keyframes without a score are left out as
// if they were not there.
LoopDetection detectLoops(const Map& map, KeyframeId current, const std::vector<double>& scores,
                          const LoopDetectionOptions& options);

// Tells of each keyframe, by number, whether a loop to it would tell something new. Not where it shares map points with
// `current`, as the paper has it, but for one thing: map reuse meets some points again before a loop is closed, most of
// them points of straight edges that fit anywhere along these. So a keyframe that shares a few is none where over
// `recent_keyframes` in a row between the two share none, and it shares less than `held_share` of the most that any
// keyframe shares with `current`.
std::vector<char> mayCloseLoop(const Map& map, KeyframeId current, const LoopDetectionOptions& options);

}  // namespace edgeslam
