// Angles in degrees and in radians. The order of the operations is part of what they are: another order would give
// other last bits.
#pragma once

#include <cmath>

namespace edgeslam {

// angle * pi / 180.
constexpr double radians(double angle_deg) { return angle_deg * M_PI / 180; }

// angle * 180 / pi.
constexpr double degrees(double angle_rad) { return angle_rad * 180 / M_PI; }

}  // namespace edgeslam
