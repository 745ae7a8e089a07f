// Rounding of what is known of a camera: so it is the same to the last bit on every processor, and when a saved map's
// camera tells it again.
#pragma once

#include <cmath>

namespace edgeslam {

// In steps of about a millionth: 2 to the power of -20.
inline double inMillionths(double value) { return std::ldexp(std::round(std::ldexp(value, 20)), -20); }

}  // namespace edgeslam
