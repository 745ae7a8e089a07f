// P26, last word: a loop is verified by the guided search of relocalisation (P22). The current keyframe is located
// against the points of the old side alone; the points that both sides have mapped give the scale; and there must be
// witnesses: descriptors that are enough by themselves, or keyframes before it, located where the first says they are.
// Bare scenes, which descriptors tell little of, are closed so, and places that only look alike to descriptors are not.
#pragma once

#include <vector>

#include "places/loop_verification.h"

namespace edgeslam {

// Pairs of points that both sides have mapped: the same piece of edge in one image.
struct ScalePairs {
  std::vector<double> log_ratios;  // of the distance on the current side over that on the old side
  std::vector<double> deviations;  // of each
};

struct ScaleEstimate {
  double log_scale = 0;
  double deviation = 0;       // standard error
  double agreeing_share = 0;  // of the pairs, within 3 deviations
};

// Weighted robust mean; nothing agrees where there are no pairs.
ScaleEstimate estimateScale(const ScalePairs& pairs);

// `descriptors`: what they say, accepted or not: their similarity is tried as a start besides the thumbnails' turn, and
// where accepted it is a witness. Accepted or not, the reason tells what was found. `inliers` are the old side's points
// in agreement. Both keyframes must have images. Same input, same result.
LoopVerification verifyLoopBySearch(const Camera& camera, const ImageReading& reading, const Map& map,
                                    KeyframeId current, KeyframeId candidate, const LoopVerification& descriptors,
                                    const LoopSearchOptions& options);

}  // namespace edgeslam
