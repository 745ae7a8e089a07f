// P24, P25: which earlier keyframes look enough like the current one to be verified as a loop.
#pragma once

#include <vector>

#include "map/map.h"

namespace edgeslam {

struct LoopDetectionOptions {
  int bar_keyframes = 5;         // P24: at most so many previous keyframes set the bar ...
  double bar_rotation_deg = 30;  // ... of those that look less than this another way [deg]
  int recent_keyframes = 10;     // so many keyframes before the current one are no candidates
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
constexpr double kNoScore = -1;

// `scores`: likeness of each earlier keyframe to `current`, in [0, 1], by keyframe number, or kNoScore where it
// cannot be compared or is culled. A keyframe is a
// candidate where it shares no map point with the current one, is not recent, and it and its neighbours in the order of
// the keyframes, `consecutive` in a row, are all over the bar; it is the best among these. Keyframes without a score
// are left out as if they were not there.
LoopDetection detectLoops(const Map& map, KeyframeId current, const std::vector<double>& scores,
                          const LoopDetectionOptions& options);

}  // namespace edgeslam
