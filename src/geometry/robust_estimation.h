// What the robust estimates of relative and of absolute pose (epipolar.h, resectioning.h) have in common.
#pragma once

namespace edgeslam {

constexpr double least_z = 0.05;             // of a bearing, for a place on the normalized image plane
constexpr double ransac_confidence = 0.999;  // that one of the samples is without a wrong match
constexpr int most_refinements = 15;

}  // namespace edgeslam
