// A sample of which nothing but its time counts.
#pragma once

#include <cstdint>

namespace edgeslam {

struct TimedSample {
  std::int64_t time_ns = 0;
  friend std::int64_t timeOf(const TimedSample& sample) { return sample.time_ns; }
};

}  // namespace edgeslam
