// The points that two tracked frames share.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "map/keyframe.h"

namespace edgeslam {

// Calls visit(index in first, index in other) for each point seen in both; both are sorted by point.
template <typename Visit>
void forEachCommon(const TrackedFrame& first, const TrackedFrame& other, Visit visit) {
  [[maybe_unused]] const auto before = [](const PointObservation& a, const PointObservation& b) {
    return a.point < b.point;
  };
  assert(std::is_sorted(first.observations.begin(), first.observations.end(), before));
  assert(std::is_sorted(other.observations.begin(), other.observations.end(), before));
  std::size_t i = 0;
  for (std::size_t j = 0; j < other.observations.size(); ++j) {
    while (i < first.observations.size() && first.observations[i].point < other.observations[j].point) ++i;
    if (i < first.observations.size() && first.observations[i].point == other.observations[j].point) visit(i, j);
  }
}

}  // namespace edgeslam
