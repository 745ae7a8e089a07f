#include "inertia/inertial_history.h"

#include <algorithm>

namespace edgeslam {
namespace {

constexpr int older_for_a_new_clock = 20;

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return static_cast<double>(to_ns - from_ns) * 1e-9; }

constexpr std::int64_t largest_time_ns = 4'000'000'000'000'000'000;
constexpr double largest_rate = 100, largest_force = 1000;  // [rad/s], [m/s^2]

}  // namespace

bool isUsable(const InertialSample& sample) {
  return sample.time_ns >= 0 && sample.time_ns <= largest_time_ns && sample.rate.allFinite() &&
         sample.force.allFinite() && sample.rate.cwiseAbs().maxCoeff() <= largest_rate &&
         sample.force.cwiseAbs().maxCoeff() <= largest_force;
}

InertialHistory::InertialHistory(const InertialUnit& unit) : unit_(unit), samples_(most_samples) {}

bool InertialHistory::add(const InertialSample& sample) {
  if (!isUsable(sample)) return false;
  if (count_ > 0 && sample.time_ns <= at(count_ - 1).time_ns) {
    if (++older_in_a_row_ < older_for_a_new_clock) return false;
    count_ = 0;
  }
  older_in_a_row_ = 0;
  if (count_ == most_samples) {
    first_ = (first_ + 1) % most_samples;
    --count_;
  }
  samples_[(first_ + count_++) % most_samples] = sample;
  return true;
}

std::size_t InertialHistory::firstAfter(std::int64_t time_ns) const {
  std::size_t begin = 0, end = count_;
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (at(middle).time_ns > time_ns) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return begin;
}

// At a time before the sample `after`; after the latest one it lasts.
InertialSample InertialHistory::interpolated(std::size_t after, std::int64_t time_ns) const {
  InertialSample sample = at(after - 1);
  if (after < count_) {
    const InertialSample& next = at(after);
    const double share = secondsBetween(sample.time_ns, time_ns) / secondsBetween(sample.time_ns, next.time_ns);
    sample.rate += share * (next.rate - sample.rate);
    sample.force += share * (next.force - sample.force);
  }
  sample.time_ns = time_ns;
  return sample;
}

std::optional<PreintegratedMotion> InertialHistory::between(std::int64_t from_ns, std::int64_t to_ns,
                                                            const InertialBias& bias) const {
  from_ns += unit_.offset_ns;
  to_ns += unit_.offset_ns;
  const std::size_t first = firstAfter(from_ns);
  if (to_ns <= from_ns || first == 0 || secondsBetween(at(count_ - 1).time_ns, to_ns) > longest_wait_s) return {};
  InertialSample last = interpolated(first, from_ns);
  std::int64_t measured_ns = at(first - 1).time_ns;
  PreintegratedMotion motion;
  motion.bias = bias;
  for (std::size_t next = first; last.time_ns < to_ns; ++next) {
    const bool is_end = next == count_ || at(next).time_ns >= to_ns;
    if (next < count_ && secondsBetween(measured_ns, at(next).time_ns) > longest_gap_s) return {};
    const InertialSample sample = is_end ? interpolated(next, to_ns) : at(next);
    motion = joined(motion, preintegrate(unit_, last, sample, bias));
    last = sample;
    measured_ns = sample.time_ns;
  }
  return motion;
}

}  // namespace edgeslam
