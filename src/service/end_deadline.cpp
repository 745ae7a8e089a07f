#include "service/end_deadline.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <optional>

#include "service/exit_code.h"

namespace edgeslam {
namespace {

constexpr auto look_interval = std::chrono::milliseconds(100);

std::chrono::nanoseconds readClock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

// In which the program did nothing, up to now, from some time on.
std::chrono::nanoseconds idleTime() { return readClock(CLOCK_MONOTONIC) - readClock(CLOCK_PROCESS_CPUTIME_ID); }

bool isAskedToEnd() {
  sigset_t pending{};
  sigpending(&pending);
  return sigismember(&pending, SIGTERM) == 1 || sigismember(&pending, SIGINT) == 1;
}

// Without destructors: they would wait for the disk.
[[noreturn]] void endAtOnce(EventLog& log) {
  log.tell("the disk does not answer: ended all the same, and what it had not taken of recordings and the map is lost");
  log.waitUntilOut();
  ::_exit(exit_failed);
}

}  // namespace

EndDeadline::EndDeadline(EventLog& log, std::chrono::nanoseconds patience)
    : log_(log), patience_(patience), thread_([this] { watch(); }) {}

EndDeadline::~EndDeadline() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void EndDeadline::begin() {
  const std::lock_guard<std::mutex> lock(mutex_);
  begun_ = true;
}

void EndDeadline::watch() {
  std::optional<std::chrono::nanoseconds> idle_at_start;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!changed_.wait_for(lock, look_interval, [this] { return stopping_; })) {
    if (!idle_at_start && (begun_ || isAskedToEnd())) idle_at_start = idleTime();
    if (idle_at_start && idleTime() - *idle_at_start > patience_) endAtOnce(log_);
  }
}

}  // namespace edgeslam
