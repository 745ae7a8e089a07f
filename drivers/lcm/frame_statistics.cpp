#include "drivers/lcm/frame_statistics.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr std::size_t most_latencies = 10000;  // where no status is asked for

// The smallest value that at least `share` of the values do not exceed; `values` are sorted.
double percentile(const std::vector<double>& values, double share) {
  if (values.empty()) return -1;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace

void FrameStatistics::add(const FrameResult& result) {
  ++frames_;
  if (isGoodPose(result.state)) ++poses_;
  if (std::isfinite(result.latency_ms) && latencies_ms_.size() < most_latencies) {
    latencies_ms_.push_back(result.latency_ms);
  }
  state_ = result.state;
  reason_ = result.reason;
}

FrameFigures FrameStatistics::take(std::int64_t now_ns) {
  FrameFigures figures;
  figures.state = state_;
  figures.reason = reason_;
  if (since_ns_ >= 0 && now_ns > since_ns_) {
    const double seconds = 1e-9 * static_cast<double>(now_ns - since_ns_);
    figures.frames_per_second = frames_ / seconds;
    figures.poses_per_second = poses_ / seconds;
  }
  std::sort(latencies_ms_.begin(), latencies_ms_.end());
  figures.latency_p50_ms = percentile(latencies_ms_, 0.5);
  figures.latency_p99_ms = percentile(latencies_ms_, 0.99);
  since_ns_ = now_ns;
  frames_ = poses_ = 0;
  latencies_ms_.clear();
  return figures;
}

}  // namespace edgeslam
