// How an inertial unit's clock differs from the camera's, as a run found it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgeslam {

struct FoundTimeOffset {
  std::int64_t offset_ns = 0;  // as InertialUnit::offset_ns
  double sigma_s = 0;          // standard deviation
};

// So many samples, and turns from frame to frame, a keyframe has room for.
constexpr std::size_t most_felt = 2048, most_turns = 256;

// So far from the offset that is given another one is looked for.
constexpr std::int64_t farthest_time_offset_ns = 100'000'000;

}  // namespace edgeslam
