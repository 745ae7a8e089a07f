#include "wheels/wheel_watch.h"

#include <algorithm>

#include "files/format_text.h"
#include "wheels/odometry_history.h"

namespace edgeslam {
namespace {

constexpr double least_rate_hz = 15;
constexpr int asked_rate_hz = 20, most_jumps = 4;

}  // namespace

WheelWatch::WheelWatch() : arrivals_({0, OdometryHistory::longest_wait_s, least_rate_hz, asked_rate_hz}) {}

void WheelWatch::add(const OdometryPose& pose) {
  arrivals_.add(timeOf(pose));
  jumped_[count_++ % jumped_.size()] = last_ && pose.utime > last_->utime && isJump(*last_, pose);
  last_ = pose;
}

std::string WheelWatch::problem() const {
  if (std::string silence = arrivals_.silence(); !silence.empty()) return silence;
  if (!arrivals_.hasSeenEnough()) return "";
  const auto jumps = static_cast<int>(std::count(jumped_.begin(), jumped_.end(), true));
  if (jumps < most_jumps) return arrivals_.timingProblem();
  return formatted("%d of the last %zu poses are a jump away from the one before; is the position in metres?", jumps,
                   jumped_.size());
}

}  // namespace edgeslam
