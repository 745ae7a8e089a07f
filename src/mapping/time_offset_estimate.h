// What frames in a row say of how an inertial unit's clock differs from the camera's: with which offset the gyroscope
// turned as the camera did (inertia/turn_fit.h).
#pragma once

#include <optional>
#include <vector>

#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

struct TimeOffsetEstimate {
  double offset_s = 0;  // as InertialUnit::offset_ns
  double sigma_s = 0;   // standard deviation
  double seconds = 0;   // of turns that both measured
};

// Of poses of frames in a row only the rotations count. Offsets about `given_s` are tried, within `farthest_s` of it.
// Nothing where the turns do not tell it, the gyroscope contradicts them whatever the offset is, or the best is at the
// end.
std::optional<TimeOffsetEstimate> estimateTimeOffset(const std::vector<PosedCamera>& frames,
                                                     const std::vector<InertialSample>& samples,
                                                     const InertialUnit& unit, double given_s, double farthest_s);

}  // namespace edgeslam
