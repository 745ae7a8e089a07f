#include "service/service_notification.h"

#include <systemd/sd-daemon.h>

#include <algorithm>
#include <cstdint>

namespace edgeslam {

ServiceNotification::ServiceNotification() {
  std::uint64_t watchdog_us = 0;
  if (sd_watchdog_enabled(/*unset_environment=*/0, &watchdog_us) > 0) {
    feeding_interval_ = std::chrono::microseconds(std::max<std::uint64_t>(watchdog_us / 4, 1));
  }
}

// A manager that takes nothing loses it: the next one says more.
void ServiceNotification::tell(const std::string& state) {
  outside_.hand([state] { sd_notify(/*unset_environment=*/0, state.c_str()); });
}

void ServiceNotification::ready() { tell("READY=1"); }

// The watchdog has nothing to watch any more, but would end a map that is long to write: the stop has a time limit of
// its own (TimeoutStopSec).
void ServiceNotification::stopping() {
  const bool is_watched = feeding_interval_ != Clock::duration::zero();
  tell(is_watched ? "STOPPING=1\nWATCHDOG_USEC=3600000000" : "STOPPING=1");
}

void ServiceNotification::status(const std::string& text) {
  if (text == status_) return;
  status_ = text;
  std::string line = text;
  std::replace(line.begin(), line.end(), '\n', ' ');  // a line of its own would be another message
  tell("STATUS=" + line);
}

void ServiceNotification::alive(Clock::time_point now) {
  const bool due = fed_ == Clock::time_point() || now - fed_ >= feeding_interval_;
  if (feeding_interval_ == Clock::duration::zero() || !due) return;
  fed_ = now;
  tell("WATCHDOG=1");
}

}  // namespace edgeslam
