#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return static_cast<double>(to_ns - from_ns) * 1e-9; }

constexpr std::int64_t largest_time_ns = 4'000'000'000'000'000'000;
constexpr double largest_rate = 100, largest_force = 1000;  // [rad/s], [m/s^2]

}  // namespace

bool isUsable(const InertialSample& sample) {
  return sample.time_ns >= 0 && sample.time_ns <= largest_time_ns && sample.rate.allFinite() &&
         sample.force.allFinite() && sample.rate.cwiseAbs().maxCoeff() <= largest_rate &&
         sample.force.cwiseAbs().maxCoeff() <= largest_force;
}

InertialHistory::InertialHistory(const InertialUnit& unit, std::size_t most) : unit_(unit), samples_(most) {}

bool InertialHistory::add(const InertialSample& sample) {
  if (!isUsable(sample) || !samples_.isNext(sample.time_ns)) return false;
  samples_.push(sample);
  return true;
}

// At a time before the sample `after`; after the latest one it lasts.
InertialSample InertialHistory::interpolated(std::size_t after, std::int64_t time_ns) const {
  InertialSample sample = samples_.at(after - 1);
  if (after < samples_.size()) {
    const InertialSample& next = samples_.at(after);
    const double share = secondsBetween(sample.time_ns, time_ns) / secondsBetween(sample.time_ns, next.time_ns);
    sample.rate += share * (next.rate - sample.rate);
    sample.force += share * (next.force - sample.force);
  }
  sample.time_ns = time_ns;
  return sample;
}

// Calls step(from, to) from sample to sample; false where some are missing.
template <typename Step>
bool InertialHistory::forEachStep(std::int64_t from_ns, std::int64_t to_ns, const Step& step) const {
  from_ns += unit_.offset_ns;
  to_ns += unit_.offset_ns;
  const std::size_t first = samples_.firstAfter(from_ns);
  if (to_ns <= from_ns || first == 0 || secondsBetween(samples_.last().time_ns, to_ns) > longest_wait_s) return false;
  InertialSample last = interpolated(first, from_ns);
  std::int64_t measured_ns = samples_.at(first - 1).time_ns;
  for (std::size_t next = first; last.time_ns < to_ns; ++next) {
    const bool is_end = next == samples_.size() || samples_.at(next).time_ns >= to_ns;
    if (next < samples_.size() && secondsBetween(measured_ns, samples_.at(next).time_ns) > longest_gap_s) return false;
    const InertialSample sample = is_end ? interpolated(next, to_ns) : samples_.at(next);
    step(last, sample);
    last = sample;
    measured_ns = sample.time_ns;
  }
  return true;
}

std::optional<PreintegratedMotion> InertialHistory::between(std::int64_t from_ns, std::int64_t to_ns,
                                                            const InertialBias& bias) const {
  PreintegratedMotion motion;
  motion.bias = bias;
  const bool is_whole = forEachStep(from_ns, to_ns, [&](const InertialSample& from, const InertialSample& to) {
    motion = joined(motion, preintegrate(unit_, from, to, bias));
  });
  return is_whole ? std::optional(motion) : std::nullopt;
}

std::optional<Eigen::Quaterniond> InertialHistory::turnBetween(std::int64_t from_ns, std::int64_t to_ns,
                                                               const InertialBias& bias) const {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  const bool is_whole = forEachStep(from_ns, to_ns, [&](const InertialSample& from, const InertialSample& to) {
    const Eigen::Vector3d rate = 0.5 * (from.rate + to.rate) - bias.rate;
    turn = (turn * rotationExp(secondsBetween(from.time_ns, to.time_ns) * rate)).normalized();
  });
  return is_whole ? std::optional(turn) : std::nullopt;
}

}  // namespace edgeslam
