// Durations counted in a table of fixed size: added by one thread without waiting, read by any other at any time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

namespace edgeslam {

std::int64_t steadyNow_ns();

struct DurationSummary {
  std::string name;
  std::int64_t count = 0;
  double mean = 0, median = 0, percentile_99 = 0, max = 0;  // [ms]; the two quantiles within 5 %
};

class DurationStatistics {
 public:
  // One thread's. Negative durations count as 0.
  void add(std::int64_t duration_ns) noexcept;
  DurationSummary summary(const std::string& name) const;

 private:
  static constexpr int buckets_per_octave = 8;
  static constexpr int octaves = 28;  // from 1 us to some 4 minutes; what is longer counts in the last bucket
  static constexpr std::size_t buckets = std::size_t{buckets_per_octave} * octaves + 1;

  static std::size_t bucketOf(std::int64_t duration_ns);
  double quantile_ms(double share, std::int64_t count) const;

  std::array<std::atomic<std::uint32_t>, buckets> counts_{};
  std::atomic<std::int64_t> sum_ns_{0}, max_ns_{0};
};

// Adds the time from its making to its end.
class Measured {
 public:
  explicit Measured(DurationStatistics& statistics) : statistics_(statistics), start_ns_(steadyNow_ns()) {}
  ~Measured() { statistics_.add(steadyNow_ns() - start_ns_); }
  Measured(const Measured&) = delete;
  Measured& operator=(const Measured&) = delete;

 private:
  DurationStatistics& statistics_;
  std::int64_t start_ns_;
};

}  // namespace edgeslam
