// Signals that ask a program for something, taken when it is ready to and not in the middle of a piece of work.
#pragma once

#include <signal.h>

namespace edgeslam {

// Blocks SIGINT, SIGTERM and SIGHUP as long as it lives. To be made before any thread is started: threads inherit that
// the signals are blocked.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigemptyset(&signals_);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, number);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

  // The number of one that came and was not taken yet, or 0. Never waits.
  int take() {
    const timespec at_once{};
    const int number = sigtimedwait(&signals_, nullptr, &at_once);
    return number > 0 ? number : 0;
  }

 private:
  sigset_t signals_{}, before_{};
};

}  // namespace edgeslam
