// Tells the service manager how the service is doing (sd_notify(3)), where there is one.
#pragma once

#include <chrono>
#include <string>

#include "service/outside_thread.h"

namespace edgeslam {

// Outside a service all of it does nothing. For one thread; never waits for the manager.
class ServiceNotification {
 public:
  using Clock = std::chrono::steady_clock;

  // Reads NOTIFY_SOCKET and WATCHDOG_USEC from the environment.
  ServiceNotification();

  // What was started works: after the start check, when frames can come.
  void ready();
  void stopping();
  // One line for `systemctl status`; only a new one is sent.
  void status(const std::string& text);

  // Feeds the watchdog: to be called for each frame that went through tracking, whatever became of its pose, and while
  // there is no camera to wait for; never from a timer. So a stalled pipeline is restarted and a covered lens is not.
  // Sent at most four times in the watchdog's time.
  void alive(Clock::time_point now);

  // Whether the manager has taken all of it within `OutsideThread::patience`.
  bool waitUntilTold() { return outside_.waitUntilTaken(); }

 private:
  void tell(const std::string& state);

  Clock::duration feeding_interval_ = Clock::duration::zero();  // 0: there is no watchdog
  Clock::time_point fed_{};
  std::string status_;
  OutsideThread outside_;
};

}  // namespace edgeslam
