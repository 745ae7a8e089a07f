// Signals that ask a program to end, taken between two pieces of work.
#pragma once

#include <signal.h>

namespace edgeslam {

// Blocks the signals that ask a program to end and tells whether one came, so that nothing is cut off in the middle.
// Threads that are started meanwhile inherit that.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&signals_);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, number);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~EndSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  bool came() {
    const timespec at_once{};
    came_ = came_ || sigtimedwait(&signals_, nullptr, &at_once) > 0;
    return came_;
  }

 private:
  sigset_t signals_{}, before_{};
  bool came_ = false;
};

}  // namespace edgeslam
