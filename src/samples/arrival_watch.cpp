#include "samples/arrival_watch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/format_text.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double longest_silence_s = 1;
constexpr double farthest_clock_s = 1;  // what is farther off is another clock

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return static_cast<double>(to_ns - from_ns) * 1e-9; }

}  // namespace

void ArrivalWatch::addFrame(std::int64_t time_ns) {
  if (first_frame_ns_ < 0) first_frame_ns_ = time_ns;
  frame_ns_ = time_ns;
  if (count_ == count_at_frame_) return;
  count_at_frame_ = count_;
  frame_with_ns_ = time_ns;
  const std::int64_t latest_ns = times_ns_[(count_ - 1) % window] - needs_.offset_ns;
  behind_s_[frames_with_++ % behind_s_.size()] = secondsBetween(latest_ns, time_ns);
}

std::string ArrivalWatch::silence() const {
  const double silence_s = secondsBetween(frames_with_ == 0 ? first_frame_ns_ : frame_with_ns_, frame_ns_);
  if (silence_s <= longest_silence_s) return "";
  return frames_with_ == 0 ? formatted("nothing has come from it for %.0f s", silence_s)
                           : formatted("nothing comes from it any more, for %.0f s", silence_s);
}

std::string ArrivalWatch::timingProblem() const {
  if (!hasSeenEnough()) return "";
  const double behind_s = upperMedian(std::vector<double>(behind_s_.begin(), behind_s_.end()));
  if (std::abs(behind_s) > farthest_clock_s) {
    return formatted("its time stamps are %.3g s from the camera's; both must be of CLOCK_MONOTONIC", behind_s);
  }
  if (behind_s > needs_.latest_s) {
    return formatted("it comes %.0f ms late; frames are tracked without it", 1e3 * behind_s);
  }
  const auto [first, last] = std::minmax_element(times_ns_.begin(), times_ns_.end());
  const double rate_hz = static_cast<double>(window - 1) / secondsBetween(*first, *last);
  if (!(rate_hz < needs_.least_rate_hz)) return "";
  return formatted("it comes %.0f times a second; %d are needed", rate_hz, needs_.asked_rate_hz);
}

}  // namespace edgeslam
