#include "wheels/odometry_history.h"

namespace edgeslam {
namespace {

constexpr std::int64_t kept_us = 5'000'000;  // frames come within this time of their capture
constexpr std::int64_t for_speed_us = 40'000;
// Of a pose's place and turn against the one before, however near in time.
constexpr double allowed_noise_m = 0.05, allowed_noise_rad = 0.1;

double secondsBetween(std::int64_t from_us, std::int64_t to_us) { return 1e-6 * static_cast<double>(to_us - from_us); }

}  // namespace

bool isJump(const OdometryPose& before, const OdometryPose& now) {
  const double seconds = secondsBetween(before.utime, now.utime);
  const double way_m = (now.local_T_body.translation - before.local_T_body.translation).norm();
  const double turn_rad = rotationAngle(before.local_T_body.rotation, now.local_T_body.rotation);
  return way_m > OdometryHistory::largest_speed_m_s * seconds + allowed_noise_m ||
         turn_rad > OdometryHistory::largest_turn_rad_s * seconds + allowed_noise_rad;
}

bool OdometryHistory::add(const OdometryPose& pose) {
  const bool was_empty = entries_.empty();
  if (!isUsable(pose) || !entries_.isNext(pose.utime)) return false;
  Entry entry{pose.utime, {pose.local_T_body, piece_, 0, 0, 0}};
  const auto goesOnFrom = [&](const Entry& last) {
    return secondsBetween(last.utime, pose.utime) <= longest_gap_s_ &&
           !isJump({last.utime, last.place.local_T_body}, pose);
  };
  if (!entries_.empty() && goesOnFrom(entries_.last())) {
    const OdometryPlace& before = entries_.last().place;
    entry.place.way_m = before.way_m + (pose.local_T_body.translation - before.local_T_body.translation).norm();
    entry.place.turn_rad = before.turn_rad + rotationAngle(before.local_T_body.rotation, pose.local_T_body.rotation);
  } else if (!was_empty) {
    entry.place.piece = ++piece_;
  }
  entries_.push(entry);
  while (entries_.at(0).utime < pose.utime - kept_us) entries_.popFirst();
  return true;
}

std::optional<OdometryPlace> OdometryHistory::at(std::int64_t utime) const {
  const std::size_t after = entries_.firstAfter(utime - 1);
  if (after == entries_.size()) return std::nullopt;
  const Entry& next = entries_.at(after);
  if (next.utime == utime) return next.place;
  if (after == 0 || entries_.at(after - 1).place.piece != next.place.piece) return std::nullopt;
  const Entry& before = entries_.at(after - 1);
  const OdometryPlace &a = before.place, &b = next.place;
  const double share = static_cast<double>(utime - before.utime) / static_cast<double>(next.utime - before.utime);
  const auto between = [&](double first, double second) { return (1 - share) * first + share * second; };
  return OdometryPlace{{a.local_T_body.rotation.slerp(share, b.local_T_body.rotation),
                        (1 - share) * a.local_T_body.translation + share * b.local_T_body.translation},
                       b.piece,
                       between(a.way_m, b.way_m),
                       between(a.turn_rad, b.turn_rad),
                       0};
}

std::optional<OdometryPlace> OdometryHistory::atOrSoonAfter(std::int64_t utime) const {
  if (entries_.empty() || utime <= entries_.last().utime) return at(utime);
  const Entry& last = entries_.last();
  const double seconds = secondsBetween(last.utime, utime);
  const std::size_t before = entries_.firstAfter(last.utime - for_speed_us);
  const Entry& first = entries_.at(before + 1 == entries_.size() && before > 0 ? before - 1 : before);
  if (seconds > longest_wait_s || first.utime == last.utime || first.place.piece != last.place.piece) {
    return std::nullopt;
  }
  const double times = seconds / secondsBetween(first.utime, last.utime);
  const Pose &a = first.place.local_T_body, &b = last.place.local_T_body;
  const Eigen::Vector3d turn = times * rotationLog((a.rotation.conjugate() * b.rotation).normalized());
  return OdometryPlace{
      {(b.rotation * rotationExp(turn)).normalized(), b.translation + times * (b.translation - a.translation)},
      last.place.piece,
      last.place.way_m + times * (last.place.way_m - first.place.way_m),
      last.place.turn_rad + times * (last.place.turn_rad - first.place.turn_rad),
      seconds};
}

std::optional<std::int64_t> OdometryHistory::newest() const {
  return entries_.empty() ? std::nullopt : std::optional(entries_.last().utime);
}

}  // namespace edgeslam
