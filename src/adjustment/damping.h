// Levenberg's and Marquardt's damping of the bundle's normal equations.
#pragma once

namespace edgeslam {

// Entries of the diagonal less than this are damped as if they were this. What is known less of a line has this.
constexpr double least_information = 1e-6;

}  // namespace edgeslam
