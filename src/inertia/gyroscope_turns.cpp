#include "inertia/gyroscope_turns.h"

#include <algorithm>

#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

double secondsBetween(const InertialSample& from, const InertialSample& to) {
  return static_cast<double>(to.time_ns - from.time_ns) * 1e-9;
}

Eigen::Vector3d interpolatedRate(const InertialSample& from, const InertialSample& to, std::int64_t time_ns) {
  const double share = static_cast<double>(time_ns - from.time_ns) / static_cast<double>(to.time_ns - from.time_ns);
  return from.rate + share * (to.rate - from.rate);
}

}  // namespace

GyroscopeTurns::GyroscopeTurns(const std::vector<InertialSample>& samples, const Eigen::Vector3d& rate_bias)
    : samples_(samples), rate_bias_(rate_bias) {
  until_.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == 0) {
      until_.emplace_back();
      continue;
    }
    Turned turned = after(until_.back(), samples[i - 1], samples[i]);
    if (secondsBetween(samples[i - 1], samples[i]) > InertialHistory::longest_gap_s) ++turned.gaps;
    until_.push_back(turned);
  }
}

// What preintegrate() says of the rotation, without the rest.
GyroscopeTurns::Turned GyroscopeTurns::after(const Turned& before, const InertialSample& from,
                                             const InertialSample& to) const {
  const double seconds = secondsBetween(from, to);
  const Eigen::Quaterniond step = rotationExp(seconds * (0.5 * (from.rate + to.rate) - rate_bias_));
  Turned turned;
  turned.rotation = (before.rotation * step).normalized();
  turned.by_bias = step.conjugate() * before.by_bias - seconds * Eigen::Matrix3d::Identity();
  turned.gaps = before.gaps;
  return turned;
}

std::optional<GyroscopeTurns::TurnedAt> GyroscopeTurns::at(std::int64_t time_ns) const {
  const auto next = std::upper_bound(samples_.begin(), samples_.end(), time_ns,
                                     [](std::int64_t time, const InertialSample& s) { return time < s.time_ns; });
  if (next == samples_.begin() || next == samples_.end()) return std::nullopt;
  const InertialSample& before = *(next - 1);
  const auto index = static_cast<std::size_t>(next - samples_.begin()) - 1;
  if (before.time_ns == time_ns) return TurnedAt{until_[index], before.rate - rate_bias_};
  if (until_[index + 1].gaps > until_[index].gaps) return std::nullopt;
  InertialSample now = before;
  now.time_ns = time_ns;
  now.rate = interpolatedRate(before, *next, time_ns);
  return TurnedAt{after(until_[index], before, now), now.rate - rate_bias_};
}

std::optional<GyroscopeTurn> GyroscopeTurns::between(std::int64_t from_ns, std::int64_t to_ns) const {
  const std::optional<TurnedAt> from = at(from_ns), to = at(to_ns);
  if (!from || !to || from->turned.gaps != to->turned.gaps) return std::nullopt;
  GyroscopeTurn turn;
  turn.rotation = (from->turned.rotation.conjugate() * to->turned.rotation).normalized();
  turn.by_bias = to->turned.by_bias - turn.rotation.conjugate() * from->turned.by_bias;
  turn.from_rate = from->rate;
  turn.to_rate = to->rate;
  return turn;
}

}  // namespace edgeslam
