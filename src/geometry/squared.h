// The square of a number that takes some writing.
#pragma once

namespace edgeslam {

constexpr double squared(double value) { return value * value; }

}  // namespace edgeslam
