// Times of a camera's stream.
#pragma once

#include <cstdint>

namespace edgeslam {

constexpr std::int64_t ms = 1'000'000;                // [ns]
constexpr std::int64_t stream_interval_ns = 33 * ms;  // from frame to frame

}  // namespace edgeslam
