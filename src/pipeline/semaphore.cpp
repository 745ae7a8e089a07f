#include "pipeline/semaphore.h"

#include <cerrno>
#include <ctime>

namespace edgeslam {

void Semaphore::wait() {
  while (sem_wait(&semaphore_) != 0 && errno == EINTR) {
  }
}

void Semaphore::waitUntil(std::int64_t steady_ns) {
  constexpr std::int64_t second_ns = 1'000'000'000;
  const timespec until{static_cast<time_t>(steady_ns / second_ns), static_cast<long>(steady_ns % second_ns)};
  while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &until) != 0 && errno == EINTR) {
  }
}

}  // namespace edgeslam
