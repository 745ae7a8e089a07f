// What an inertial unit measured in the last seconds, and the motion between two times of it.
#pragma once

#include <optional>

#include "inertia/preintegration.h"
#include "samples/sample_ring.h"

namespace edgeslam {

// What a unit can have measured: finite, within what any unit measures, its time not negative and at most 4e18 ns.
bool isUsable(const InertialSample& sample);

class InertialHistory {
 public:
  // Takes all its memory at once, for so many samples.
  explicit InertialHistory(const InertialUnit& unit, std::size_t most = most_samples);

  const InertialUnit& unit() const { return unit_; }
  // From now on, of all that was measured.
  void setOffset(std::int64_t offset_ns) { unit_.offset_ns = offset_ns; }

  // In the order in which they come. False where it cannot be used and is left out: not finite, beyond what any unit
  // measures, or its time stamp not after the one before. Where many in a row are older, the clock was set back: what
  // was before is forgotten.
  bool add(const InertialSample& sample);

  // Between two times of the camera's clock, `to_ns` after `from_ns`. None where samples are missing: at the beginning,
  // for longer than `longest_gap_s` in between, or for longer than `longest_wait_s` at the end, where the latest one is
  // taken to last.
  std::optional<PreintegratedMotion> between(std::int64_t from_ns, std::int64_t to_ns, const InertialBias& bias) const;

  // How the unit turned, from its frame at the first time to that at the second; none likewise. Takes little time over
  // many seconds.
  std::optional<Eigen::Quaterniond> turnBetween(std::int64_t from_ns, std::int64_t to_ns,
                                                const InertialBias& bias) const;

  static constexpr double longest_gap_s = 0.06, longest_wait_s = 0.02;
  static constexpr std::size_t most_samples = 8192;  // two seconds of the fastest units

 private:
  InertialSample interpolated(std::size_t after, std::int64_t time_ns) const;
  template <typename Step>
  bool forEachStep(std::int64_t from_ns, std::int64_t to_ns, const Step& step) const;

  InertialUnit unit_;
  SampleRing<InertialSample> samples_;
};

}  // namespace edgeslam
