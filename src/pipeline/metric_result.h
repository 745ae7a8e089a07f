// A run's result in metres and upright, where an inertial unit tells how its worlds lie to the earth, or in metres,
// where wheels tell how long its worlds' units are.
#pragma once

#include "map/map.h"
#include "pipeline/run_result.h"

namespace edgeslam {

// Moves all poses, points and lines of the worlds that `map` knows the lie of: lengths are metres then, by inertia
// z is up, and the origin stays.
void makeMetric(const Map& map, RunResult& result);

}  // namespace edgeslam
