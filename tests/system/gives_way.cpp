// Part of a program whose tests do not hang on time, or some of them do not: those leave the processors to others
// first.
#include <unistd.h>

#include <cstdlib>

namespace {

bool giveWay() {
  constexpr int lower_priority = 10;
  return std::getenv("EDGESLAM_HANGS_ON_TIME") == nullptr && ::nice(lower_priority) != -1;
}

[[maybe_unused]] const bool gives_way = giveWay();  // before main()

}  // namespace
