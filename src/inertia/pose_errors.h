// How errors of a camera's poses hang together, for least squares over what a recording shows of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/median.h"

namespace edgeslam {

// Poses err in a map with the motion, too, in the same way throughout: over eight sequences with known truth, rotations
// and offsets were off by 1.3 times what the scatter of parts says; so many times are told.
constexpr double unseen_times = 1.5;

// Parts of a recording whose errors have little to do with each other: at most 2 s long, and at least about twelve of
// them. Both times are of what is taken from it; the length is in ns, and not 0.
inline std::int64_t partLength(std::int64_t first_ns, std::int64_t last_ns) {
  constexpr std::int64_t longest_ns = 2'000'000'000, fewest = 12;
  return std::min(longest_ns, (last_ns - first_ns) / fewest) + 1;
}

// Cauchy's weights of errors of these lengths, 0 to 1: frames that were posed wrongly count little. An error of four
// medians has half the weight.
inline std::vector<double> cauchyWeights(const std::vector<double>& lengths) {
  constexpr double medians = 4, least = 1e-9;
  const double bound = std::max(least, medians * medianOr(0.0, lengths));
  std::vector<double> weights;
  weights.reserve(lengths.size());
  for (const double length : lengths) weights.push_back(1 / (1 + length * length / (bound * bound)));
  return weights;
}

}  // namespace edgeslam
