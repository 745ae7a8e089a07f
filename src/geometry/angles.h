// Degrees for people and configurations, radians for calculations.
#pragma once

#include <cmath>

namespace edgeslam {

constexpr double radians(double degrees) { return degrees * M_PI / 180; }
constexpr double degrees(double radians) { return radians * 180 / M_PI; }

}  // namespace edgeslam
