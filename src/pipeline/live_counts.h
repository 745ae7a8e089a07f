// Counters of a live run, as of now.
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgeslam {

struct LiveCounts {
  std::int64_t captured = 0;
  std::int64_t processed = 0;
  std::int64_t passed_over = 0;     // a newer frame was there when tracking came to take it
  std::int64_t mapping_behind = 0;  // frames that told mapping nothing, its queue being nearly full
  std::int64_t not_published = 0;   // results for which the publishing queue was full
  std::size_t messages_waiting = 0;
  std::size_t results_waiting = 0;
  std::int64_t map_changes = 0;  // messages and corrections that mapping took in
  std::size_t keyframes = 0;     // of the map; 0 while there is none
  std::size_t points = 0;
};

}  // namespace edgeslam
