// Where the wheel odometry says that the body was, at any time of the last seconds.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "wheels/odometry_pose.h"

namespace edgeslam {

class OdometryHistory {
 public:
  // Without a pose for longer than `longest_gap_s`, another piece begins.
  explicit OdometryHistory(double longest_gap_s = 0.25) : longest_gap_s_(longest_gap_s) {}

  // In the order in which they come. A pose whose time stamp is not after the one before is left out; where many in a
  // row are older, the robot's clock was set back: what was before is forgotten. A gap in time and a jump in place
  // begin another piece.
  void add(const OdometryPose& pose);

  // Between the two messages around that time; none where there are none (yet), or they are of two pieces.
  std::optional<OdometryPlace> at(std::int64_t utime) const;
  // Time stamp of the newest; none where there is none.
  std::optional<std::int64_t> newest() const;

  static constexpr double largest_speed_m_s = 20, largest_turn_rad_s = 20;

 private:
  struct Entry {
    std::int64_t utime = 0;
    OdometryPlace place;
  };

  bool isContinuous(const Entry& before, const OdometryPose& now) const;

  double longest_gap_s_;
  std::deque<Entry> entries_;  // time stamps ascend
  std::int64_t piece_ = 0;
  int older_in_a_row_ = 0;
};

}  // namespace edgeslam
