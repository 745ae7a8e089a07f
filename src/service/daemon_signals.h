// The signals that a daemon acts on, taken when it is ready to: SIGTERM and SIGINT end it, SIGHUP writes the map.
#pragma once

#include <utility>

#include "service/blocked_signals.h"

namespace edgeslam {

// To be made before any thread is started: threads inherit that the signals are blocked.
class DaemonSignals {
 public:
  // True from when the daemon is to end.
  bool end() {
    take();
    return end_;
  }
  // True once for each time that the map is to be written.
  bool takeMapWish() {
    take();
    return std::exchange(map_wish_, false);
  }

 private:
  void take() {
    while (const int number = signals_.take()) (number == SIGHUP ? map_wish_ : end_) = true;
  }

  BlockedSignals signals_;
  bool end_ = false, map_wish_ = false;
};

}  // namespace edgeslam
