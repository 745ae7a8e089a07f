// Signals that ask a program to end, taken between two pieces of work.
#pragma once

#include "service/blocked_signals.h"

namespace edgeslam {

// Tells whether one came, so that nothing is cut off in the middle. Threads that are started meanwhile inherit that the
// signals are blocked.
class EndSignals {
 public:
  bool came() {
    came_ = came_ || signals_.take() != 0;
    return came_;
  }

 private:
  BlockedSignals signals_;
  bool came_ = false;
};

}  // namespace edgeslam
