#include "pipeline/duration_statistics.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double shortest_ns = 1000;  // what is shorter counts in the first bucket

}  // namespace

std::int64_t steadyNow_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

std::size_t DurationStatistics::bucketOf(std::int64_t duration_ns) {
  const double ratio = static_cast<double>(duration_ns) / shortest_ns;
  if (!(ratio > 1)) return 0;
  const double place = std::ceil(buckets_per_octave * std::log2(ratio));
  return std::min(static_cast<std::size_t>(place), buckets - 1);
}

void DurationStatistics::add(std::int64_t duration_ns) noexcept {
  const std::int64_t duration = std::max<std::int64_t>(0, duration_ns);
  counts_[bucketOf(duration)].fetch_add(1, std::memory_order_relaxed);
  sum_ns_.fetch_add(duration, std::memory_order_relaxed);
  if (duration > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(duration, std::memory_order_relaxed);
}

// The middle of the bucket that the nearest-rank quantile falls into.
double DurationStatistics::quantile_ms(double share, std::int64_t count) const {
  const auto rank = std::max<std::int64_t>(1, std::llround(std::ceil(share * static_cast<double>(count))));
  std::int64_t below = 0;
  for (std::size_t i = 0; i < buckets; ++i) {
    below += counts_[i].load(std::memory_order_relaxed);
    if (below >= rank) {
      return 1e-6 * shortest_ns * std::exp2((static_cast<double>(i) - 0.5) / static_cast<double>(buckets_per_octave));
    }
  }
  return 0;
}

DurationSummary DurationStatistics::summary(const std::string& name) const {
  DurationSummary summary;
  summary.name = name;
  for (const auto& count : counts_) summary.count += count.load(std::memory_order_relaxed);
  if (summary.count == 0) return summary;
  summary.mean =
      1e-6 * static_cast<double>(sum_ns_.load(std::memory_order_relaxed)) / static_cast<double>(summary.count);
  summary.max = 1e-6 * static_cast<double>(max_ns_.load(std::memory_order_relaxed));
  summary.median = std::min(summary.max, quantile_ms(0.5, summary.count));
  summary.percentile_99 = std::min(summary.max, quantile_ms(0.99, summary.count));
  return summary;
}

}  // namespace edgeslam
