// Where the wheel odometry says that the body was, at any time of the last seconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "samples/sample_ring.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

// Farther, or turned further, than any robot moves in the time between.
bool isJump(const OdometryPose& before, const OdometryPose& now);

class OdometryHistory {
 public:
  // Takes all its memory at once. Without a pose for longer than `longest_gap_s`, another piece begins.
  explicit OdometryHistory(double longest_gap_s = 0.25) : longest_gap_s_(longest_gap_s), entries_(most_poses) {}

  // In the order in which they come. False where it is left out: it cannot be used, or its time stamp is not after the
  // one before; where many in a row are older, the robot's clock was set back: what was before is forgotten. A gap in
  // time and a jump in place begin another piece.
  bool add(const OdometryPose& pose);

  // Between the two messages around that time; none where there are none (yet), or they are of two pieces.
  std::optional<OdometryPlace> at(std::int64_t utime) const;
  // The same, and for up to `longest_wait_s` after the newest message, as the body moved on.
  std::optional<OdometryPlace> atOrSoonAfter(std::int64_t utime) const;
  // Time stamp of the newest; none where there is none.
  std::optional<std::int64_t> newest() const;

  static constexpr double largest_speed_m_s = 20, largest_turn_rad_s = 20;
  static constexpr double longest_wait_s = 0.05;
  static constexpr std::size_t most_poses = 4096;

 private:
  struct Entry {
    std::int64_t utime = 0;
    OdometryPlace place;
    friend std::int64_t timeOf(const Entry& entry) { return entry.utime; }
  };

  double longest_gap_s_;
  SampleRing<Entry> entries_;
  std::int64_t piece_ = 0;
};

}  // namespace edgeslam
