// Where an inertial unit's range ends: what is beyond it is cut off, and comes as the same value again and again.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam {

class SaturationWatch {
 public:
  // In the order of time.
  void add(const InertialSample& sample);

  // In a line, of the last 10 s; empty where nothing was cut off.
  std::string problem() const;

 private:
  // Of x, y, z of the rate, and then of the force.
  struct Axis {
    double largest = 0;                  // that came ever, without its sign
    double last = 0;                     // with it
    int repeated = 0;                    // so many times in a row, while it is the largest
    std::optional<std::int64_t> cut_ns;  // when that was too often last
  };

  std::array<Axis, 6> axes_;
  std::int64_t time_ns_ = 0;  // of the last sample
};

// Of a recording, wherever in it; empty where nothing was cut off. Ascending times.
std::string saturationProblem(const std::vector<InertialSample>& samples);

}  // namespace edgeslam
