// How finely the report tells numbers, times and series: what a screen can show.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pipeline/run_result.h"

namespace edgeslam {

constexpr std::size_t most_samples = 4000;  // of a series over time: more than a screen has columns

// Rounds to a power of ten, dividing by its inverse where that is a whole number, so that decimals print short.
class Rounding {
 public:
  explicit Rounding(double step) {
    const double exponent = std::ceil(std::log10(std::max(step, 1e-12)) - 1e-9);
    unit_ = std::pow(10.0, std::abs(exponent));
    divides_ = exponent <= 0;
  }
  double step() const { return divides_ ? 1 / unit_ : unit_; }
  double steps(double value) const { return std::round(divides_ ? value * unit_ : value / unit_); }
  double operator()(double value) const { return divides_ ? steps(value) / unit_ : steps(value) * unit_; }

 private:
  double unit_ = 1;
  bool divides_ = true;
};

// Every how many of `count` are taken, so that there are at most `most`.
inline std::size_t strideFor(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

// Seconds since the first frame, to the millisecond.
class Clock {
 public:
  explicit Clock(const RunResult& result) : start_(result.frames.empty() ? 0 : result.frames.front().time_ns) {}
  double operator()(std::int64_t time_ns) const { return milliseconds_(1e-9 * static_cast<double>(time_ns - start_)); }

 private:
  std::int64_t start_;
  Rounding milliseconds_{1e-3};
};

}  // namespace edgeslam
