// A run's result in metres and upright, where an inertial unit tells how its worlds lie to the earth.
#pragma once

#include "map/map.h"
#include "pipeline/run_result.h"

namespace edgeslam {

// Moves all poses, points and lines of the worlds that `map` knows the lie of: lengths are metres then, z is up, and
// the origin stays.
void makeMetric(const Map& map, RunResult& result);

}  // namespace edgeslam
