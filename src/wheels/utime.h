// Time stamps as robots' messages carry them.
#pragma once

#include <cstdint>

namespace edgeslam {

// Microseconds, rounded down.
inline std::int64_t utimeOf(std::int64_t time_ns) { return time_ns / 1000 - (time_ns % 1000 < 0 ? 1 : 0); }

}  // namespace edgeslam
