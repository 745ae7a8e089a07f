// The signals that a daemon acts on, taken when it is ready to: SIGTERM and SIGINT end it, SIGHUP writes the map.
#pragma once

#include <signal.h>

namespace edgeslam {

// To be made before any thread is started: threads inherit that the signals are blocked.
class DaemonSignals {
 public:
  DaemonSignals() {
    sigemptyset(&signals_);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, number);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~DaemonSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  DaemonSignals(const DaemonSignals&) = delete;
  DaemonSignals& operator=(const DaemonSignals&) = delete;

  // True from when the daemon is to end.
  bool end() {
    take();
    return end_;
  }
  // True once for each time that the map is to be written.
  bool takeMapWish() {
    take();
    const bool wish = map_wish_;
    map_wish_ = false;
    return wish;
  }

 private:
  void take() {
    const timespec at_once{};
    for (int number = 0; (number = sigtimedwait(&signals_, nullptr, &at_once)) > 0;) {
      (number == SIGHUP ? map_wish_ : end_) = true;
    }
  }

  sigset_t signals_{}, before_{};
  bool end_ = false, map_wish_ = false;
};

}  // namespace edgeslam
