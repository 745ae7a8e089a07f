// Angles of tests are told in degrees.
#pragma once

#include <cmath>

namespace edgeslam {

constexpr double degree = M_PI / 180;  // [rad]

}  // namespace edgeslam
