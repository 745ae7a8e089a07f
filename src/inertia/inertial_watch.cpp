#include "inertia/inertial_watch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/format_text.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double longest_silence_s = 1;
constexpr double farthest_clock_s = 1;  // what is farther off is another clock
constexpr double latest_s = 0.02;       // behind its frame: more, and frames are tracked without
constexpr double least_rate_hz = 50;

}  // namespace

std::string unitsProblem(double median_force, double median_rate) {
  constexpr double least_force = 3, most_force = 40, most_rate = 12;
  if (median_force < least_force || median_force > most_force) {
    return formatted("the specific force is %.3g in the median; expected about 9.8, in m/s^2 with gravity included",
                     median_force) +
           (median_force > 0.5 && median_force < 1.5 ? ": is it in multiples of g?" : "");
  }
  if (median_rate > most_rate) {
    return formatted("the rate of turning is %.3g in the median; expected rad/s: is it in degrees?", median_rate);
  }
  return "";
}

void InertialWatch::add(const InertialSample& sample) {
  seen_[count_++ % window] = {sample.time_ns, sample.rate.norm(), sample.force.norm()};
}

void InertialWatch::addFrame(std::int64_t time_ns) {
  if (first_frame_ns_ < 0) first_frame_ns_ = time_ns;
  frame_ns_ = time_ns;
  if (count_ == count_at_frame_) return;
  count_at_frame_ = count_;
  frame_with_ns_ = time_ns;
  const std::int64_t latest_ns = seen_[(count_ - 1) % window].time_ns - offset_ns_;
  behind_s_[frames_with_++ % behind_s_.size()] = static_cast<double>(time_ns - latest_ns) * 1e-9;
}

std::string InertialWatch::problem() const {
  const std::int64_t since_ns = frames_with_ == 0 ? first_frame_ns_ : frame_with_ns_;
  if (const double silence_s = static_cast<double>(frame_ns_ - since_ns) * 1e-9; silence_s > longest_silence_s) {
    return frames_with_ == 0 ? formatted("nothing has come from it for %.0f s", silence_s)
                             : formatted("nothing comes from it any more, for %.0f s", silence_s);
  }
  if (count_ < window || frames_with_ < behind_s_.size()) return "";
  std::vector<double> forces, rates, times_s;
  for (const Seen& seen : seen_) {
    forces.push_back(seen.force);
    rates.push_back(seen.rate);
    times_s.push_back(static_cast<double>(seen.time_ns - seen_[0].time_ns) * 1e-9);
  }
  if (std::string wrong = unitsProblem(upperMedian(std::move(forces)), upperMedian(std::move(rates))); !wrong.empty()) {
    return wrong;
  }
  const double behind_s = upperMedian(std::vector<double>(behind_s_.begin(), behind_s_.end()));
  if (std::abs(behind_s) > farthest_clock_s) {
    return formatted("its time stamps are %.3g s from the camera's; both must be of CLOCK_MONOTONIC", behind_s);
  }
  if (behind_s > latest_s) return formatted("it comes %.0f ms late; frames are tracked without it", 1e3 * behind_s);
  const auto [first, last] = std::minmax_element(times_s.begin(), times_s.end());
  const double rate_hz = static_cast<double>(window - 1) / (*last - *first);
  return rate_hz < least_rate_hz ? formatted("it comes %.0f times a second; 100 are needed", rate_hz) : "";
}

}  // namespace edgeslam
