#include "wheels/odometry_history.h"

#include <algorithm>

namespace edgeslam {
namespace {

constexpr std::int64_t kept_us = 5'000'000;  // frames come within this time of their capture
constexpr std::size_t most_entries = 5000;
constexpr int older_means_set_back = 20;
// Of a pose's place and turn against the one before, however near in time.
constexpr double allowed_noise_m = 0.05, allowed_noise_rad = 0.1;

}  // namespace

bool OdometryHistory::isContinuous(const Entry& before, const OdometryPose& now) const {
  const double seconds = 1e-6 * static_cast<double>(now.utime - before.utime);
  const double way_m = (now.local_T_body.translation - before.place.local_T_body.translation).norm();
  const double turn_rad = rotationAngle(before.place.local_T_body.rotation, now.local_T_body.rotation);
  return seconds <= longest_gap_s_ && way_m <= largest_speed_m_s * seconds + allowed_noise_m &&
         turn_rad <= largest_turn_rad_s * seconds + allowed_noise_rad;
}

void OdometryHistory::add(const OdometryPose& pose) {
  if (!entries_.empty() && pose.utime <= entries_.back().utime) {
    if (pose.utime < entries_.back().utime) ++older_in_a_row_;
    if (older_in_a_row_ < older_means_set_back) return;
    entries_.clear();
    ++piece_;
  }
  older_in_a_row_ = 0;
  Entry entry{pose.utime, {pose.local_T_body, piece_, 0, 0}};
  if (!entries_.empty() && isContinuous(entries_.back(), pose)) {
    const OdometryPlace& before = entries_.back().place;
    entry.place.way_m = before.way_m + (pose.local_T_body.translation - before.local_T_body.translation).norm();
    entry.place.turn_rad = before.turn_rad + rotationAngle(before.local_T_body.rotation, pose.local_T_body.rotation);
  } else if (!entries_.empty()) {
    entry.place.piece = ++piece_;
  }
  entries_.push_back(entry);
  while (entries_.size() > most_entries || entries_.front().utime < pose.utime - kept_us) entries_.pop_front();
}

std::optional<OdometryPlace> OdometryHistory::at(std::int64_t utime) const {
  const auto after = std::lower_bound(entries_.begin(), entries_.end(), utime,
                                      [](const Entry& entry, std::int64_t time) { return entry.utime < time; });
  if (after == entries_.end()) return std::nullopt;
  if (after->utime == utime) return after->place;
  if (after == entries_.begin() || std::prev(after)->place.piece != after->place.piece) return std::nullopt;
  const OdometryPlace &a = std::prev(after)->place, &b = after->place;
  const double share = static_cast<double>(utime - std::prev(after)->utime) /
                       static_cast<double>(after->utime - std::prev(after)->utime);
  const auto between = [&](double first, double second) { return (1 - share) * first + share * second; };
  return OdometryPlace{{a.local_T_body.rotation.slerp(share, b.local_T_body.rotation),
                        (1 - share) * a.local_T_body.translation + share * b.local_T_body.translation},
                       b.piece,
                       between(a.way_m, b.way_m),
                       between(a.turn_rad, b.turn_rad)};
}

std::optional<std::int64_t> OdometryHistory::newest() const {
  return entries_.empty() ? std::nullopt : std::optional(entries_.back().utime);
}

}  // namespace edgeslam
