// What an inertial unit measured in the last seconds, and the motion between two times of it.
#pragma once

#include <optional>
#include <vector>

#include "inertia/preintegration.h"

namespace edgeslam {

// What a unit can have measured: finite, within what any unit measures, its time not negative and at most 4e18 ns.
bool isUsable(const InertialSample& sample);

class InertialHistory {
 public:
  // Takes all its memory at once.
  explicit InertialHistory(const InertialUnit& unit);

  const InertialUnit& unit() const { return unit_; }

  // In the order in which they come. False where it cannot be used and is left out: not finite, beyond what any unit
  // measures, or its time stamp not after the one before. Where many in a row are older, the clock was set back: what
  // was before is forgotten.
  bool add(const InertialSample& sample);

  // Between two times of the camera's clock, `to_ns` after `from_ns`. None where samples are missing: at the beginning,
  // for longer than `longest_gap_s` in between, or for longer than `longest_wait_s` at the end, where the latest one is
  // taken to last.
  std::optional<PreintegratedMotion> between(std::int64_t from_ns, std::int64_t to_ns, const InertialBias& bias) const;

  static constexpr double longest_gap_s = 0.06, longest_wait_s = 0.02;
  static constexpr std::size_t most_samples = 8192;  // two seconds of the fastest units

 private:
  const InertialSample& at(std::size_t place) const { return samples_[(first_ + place) % most_samples]; }
  std::size_t firstAfter(std::int64_t time_ns) const;
  InertialSample interpolated(std::size_t after, std::int64_t time_ns) const;

  InertialUnit unit_;
  std::vector<InertialSample> samples_;  // a ring
  std::size_t first_ = 0, count_ = 0;
  int older_in_a_row_ = 0;
};

}  // namespace edgeslam
