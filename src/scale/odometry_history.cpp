#include "scale/odometry_history.h"

#include <algorithm>

namespace edgeslam {
namespace {

constexpr std::int64_t kept_us = 5'000'000;  // frames come within this time of their capture
constexpr std::size_t most_entries = 5000;
constexpr int older_means_set_back = 20;
// Of a pose's place and turn against the one before, however near in time.
constexpr double allowed_noise_m = 0.05, allowed_noise_rad = 0.1;

bool isContinuous(const OdometryPose& before, const OdometryPose& now) {
  const double seconds = 1e-6 * static_cast<double>(now.utime - before.utime);
  const double way_m = (now.local_T_body.translation - before.local_T_body.translation).norm();
  const double turn_rad = rotationAngle(before.local_T_body.rotation, now.local_T_body.rotation);
  return seconds <= OdometryHistory::longest_gap_s &&
         way_m <= OdometryHistory::largest_speed_m_s * seconds + allowed_noise_m &&
         turn_rad <= OdometryHistory::largest_turn_rad_s * seconds + allowed_noise_rad;
}

}  // namespace

void OdometryHistory::add(const OdometryPose& pose) {
  if (!entries_.empty() && pose.utime <= entries_.back().pose.utime) {
    if (pose.utime < entries_.back().pose.utime) ++older_in_a_row_;
    if (older_in_a_row_ < older_means_set_back) return;
    entries_.clear();
    ++piece_;
  }
  older_in_a_row_ = 0;
  if (!entries_.empty() && !isContinuous(entries_.back().pose, pose)) ++piece_;
  entries_.push_back({pose, piece_});
  while (entries_.size() > most_entries || entries_.front().pose.utime < pose.utime - kept_us) entries_.pop_front();
}

std::optional<OdometryHistory::At> OdometryHistory::at(std::int64_t utime) const {
  const auto after = std::lower_bound(entries_.begin(), entries_.end(), utime,
                                      [](const Entry& entry, std::int64_t time) { return entry.pose.utime < time; });
  if (after == entries_.end()) return std::nullopt;
  if (after->pose.utime == utime) return At{after->pose.local_T_body, after->piece};
  if (after == entries_.begin() || std::prev(after)->piece != after->piece) return std::nullopt;
  const OdometryPose &a = std::prev(after)->pose, &b = after->pose;
  const double share = static_cast<double>(utime - a.utime) / static_cast<double>(b.utime - a.utime);
  return At{{a.local_T_body.rotation.slerp(share, b.local_T_body.rotation),
             (1 - share) * a.local_T_body.translation + share * b.local_T_body.translation},
            after->piece};
}

std::optional<std::int64_t> OdometryHistory::newest() const {
  return entries_.empty() ? std::nullopt : std::optional(entries_.back().pose.utime);
}

}  // namespace edgeslam
