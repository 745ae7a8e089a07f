// Rates and latencies over the time between two statuses.
#pragma once

#include <string>
#include <vector>

#include "tracking/frame_result.h"

namespace edgeslam {

struct FrameFigures {
  TrackingState state = TrackingState::initialising;  // of the latest frame
  std::string reason;
  double frames_per_second = -1;  // -1: not known
  double poses_per_second = -1;   // measured ones
  double latency_p50_ms = -1;
  double latency_p99_ms = -1;
};

class FrameStatistics {
 public:
  void add(const FrameResult& result);

  // Since the call before, and begins anew. `now_ns` of a clock that only goes forward; the first call gives no rates.
  FrameFigures take(std::int64_t now_ns);

 private:
  std::int64_t since_ns_ = -1;
  int frames_ = 0, poses_ = 0;
  std::vector<double> latencies_ms_;  // at most most_latencies
  TrackingState state_ = TrackingState::initialising;
  std::string reason_;
};

}  // namespace edgeslam
