// Saved maps of one place made into one. Keyframes of the one are looked for in the other, as lost frames are; where
// several agree on how the maps lie to each other, these are one. Otherwise loops are looked for as a run would have
// closed them that had come from the one into the other.
#pragma once

#include <string>

#include "geometry/camera.h"
#include "map/map.h"
#include "pipeline/settings.h"

namespace edgeslam {

struct MapJoining {
  bool is_joined = false;    // at least one world of each is the same now
  int keyframes = 0;         // of both, that were looked for in the other
  int found = 0;             // of these, found there
  std::size_t agreeing = 0;  // of these, that say the same of how the maps lie to each other
  int alike = 0;             // otherwise: pairs of keyframes that look alike and were compared by their points
  int loops = 0;             // of these, closed
  std::string nearest_loop;  // what became of the pair with most points in agreement, in words; empty: none is alike
};

// Adds a map to another one of the same camera: with numbers after its own, worlds that are found to be one joined, and
// these adjusted as a whole. Where no common place is found `map` stays as it is. Throws InputError where both have
// more keyframes or points than numbers are for.
MapJoining joinMap(const Camera& camera, const Settings& settings, const Map& added, Map& map);

}  // namespace edgeslam
