// Where another node says that the body is in `odom`: map -> odom has to go together with that one's odom -> body,
// which is another frame than our own.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "geometry/pose.h"

namespace edgeslam {

class HeardOdometry {
 public:
  // One that is not finite, or has no rotation, is left out. One older than the latest begins anew: the clock was set.
  void add(std::int64_t stamp_ns, const Pose& odom_T_body);

  // Between its two neighbours, which are at most longest_gap_ns apart; none where there are no such two.
  std::optional<Pose> at(std::int64_t stamp_ns) const;

  static constexpr std::int64_t longest_gap_ns = 500'000'000;

 private:
  struct Heard {
    std::int64_t stamp_ns;
    Pose odom_T_body;
  };
  std::deque<Heard> heard_;  // in order of time, of the last seconds
};

}  // namespace edgeslam
