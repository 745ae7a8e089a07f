#include "drivers/ros2/heard_odometry.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr std::int64_t kept_ns = 5'000'000'000;
constexpr std::size_t most_kept = 5000;  // 1000 a second

}  // namespace

void HeardOdometry::add(std::int64_t stamp_ns, const Pose& odom_T_body) {
  const double norm = odom_T_body.rotation.norm();
  if (!odom_T_body.translation.allFinite() || !(std::abs(norm - 1) < 0.01)) return;
  if (!heard_.empty() && stamp_ns == heard_.back().stamp_ns) return;
  if (!heard_.empty() && stamp_ns < heard_.back().stamp_ns) heard_.clear();
  heard_.push_back({stamp_ns, {odom_T_body.rotation.normalized(), odom_T_body.translation}});
  while (heard_.size() > most_kept || heard_.front().stamp_ns < stamp_ns - kept_ns) heard_.pop_front();
}

std::optional<Pose> HeardOdometry::at(std::int64_t stamp_ns) const {
  const auto after = std::lower_bound(heard_.begin(), heard_.end(), stamp_ns,
                                      [](const Heard& heard, std::int64_t stamp) { return heard.stamp_ns < stamp; });
  if (after == heard_.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->odom_T_body;
  if (after == heard_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const std::int64_t gap_ns = after->stamp_ns - before->stamp_ns;
  if (gap_ns > longest_gap_ns) return std::nullopt;
  const double share = static_cast<double>(stamp_ns - before->stamp_ns) / static_cast<double>(gap_ns);
  const Pose &from = before->odom_T_body, &to = after->odom_T_body;
  return Pose{from.rotation.slerp(share, to.rotation), from.translation + share * (to.translation - from.translation)};
}

}  // namespace edgeslam
