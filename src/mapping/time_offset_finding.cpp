#include "mapping/time_offset_finding.h"

#include <algorithm>
#include <cmath>

#include "inertia/inertial_history.h"
#include "inertia/samples_since.h"

namespace edgeslam {
namespace {

constexpr std::size_t most_samples_kept = 32768;  // links between keyframes are measured anew with them
constexpr double longest_looked_at_s = 20, shortest_looked_at_s = 2;
// Of turns, from one look to the next: at first, once it was found, and where it stays as it is.
constexpr double look_interval_s = 1, interval_found_s = 4, interval_steady_s = 10;
constexpr int steady_looks = 4;
constexpr double known_offset_s = 2e-3, well_known_offset_s = 1e-3;  // standard deviations: to find one, to find none
constexpr double least_s = 2e-3;                                     // less is no harm: it is as given
constexpr double least_sigmas = 5;                                   // of what is another one
constexpr int agreeing_looks = 3;                                    // in a row, ...
constexpr double agreement_s = 2e-3;                                 // ... within this, or ...
constexpr double alike_offsets = 0.25;                               // ... this of what they say
constexpr double bends_s = 1e-3;                                     // change that tells in the map
constexpr double too_little_s = 3e-4;                                // change of what was found

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return 1e-9 * static_cast<double>(to_ns - from_ns); }

}  // namespace

bool TimeOffsetFinding::add(std::int64_t keyframe_ns, const std::vector<InertialSample>& felt,
                            const std::vector<CameraTurn>& turns) {
  keepSamples(felt);
  keepTurns(turns);
  if (!samples_.empty()) ahead_ns_[keyframes_++ % ahead_ns_.size()] = samples_.back().time_ns - keyframe_ns;
  const double interval = steady_ >= steady_looks ? interval_steady_s : found_ ? interval_found_s : look_interval_s;
  if (since_look_s_ < interval) return false;
  since_look_s_ = 0;
  return look();
}

bool TimeOffsetFinding::comesInTime() const {
  const std::int64_t least_ahead_ns = *std::min_element(ahead_ns_.begin(), ahead_ns_.end());
  return keyframes_ >= ahead_ns_.size() && found_ &&
         secondsBetween(least_ahead_ns, found_->offset_ns) <= InertialHistory::longest_wait_s;
}

void TimeOffsetFinding::setRotation(const Eigen::Quaterniond& imu_R_camera, bool was_map_bent) {
  unit_.imu_T_camera.rotation = imu_R_camera;
  if (was_map_bent) frames_.clear();
}

void TimeOffsetFinding::keepSamples(const std::vector<InertialSample>& felt) {
  for (const InertialSample& sample : felt) {
    if (!samples_.empty() && sample.time_ns <= samples_.back().time_ns) samples_.clear();  // its clock was set back
    samples_.push_back(sample);
  }
  if (samples_.size() > 2 * most_samples_kept) {
    samples_.erase(samples_.begin(), samples_.end() - static_cast<std::ptrdiff_t>(most_samples_kept));
  }
}

void TimeOffsetFinding::keepTurns(const std::vector<CameraTurn>& turns) {
  for (const CameraTurn& turn : turns) {
    if (!frames_.empty() && turn.from_ns < frames_.back().time_ns) frames_.clear();
    if (frames_.empty() || turn.from_ns != frames_.back().time_ns) {
      const int stretch = frames_.empty() ? 0 : frames_.back().world + 1;
      frames_.push_back({turn.from_ns, stretch, Pose()});
    }
    Pose pose;
    pose.rotation = (frames_.back().world_T_camera.rotation * turn.rotation).normalized();
    frames_.push_back({turn.to_ns, frames_.back().world, pose});
    since_look_s_ += secondsOf(turn);
  }
  const auto is_young = [&](const PosedCamera& frame) {
    return secondsBetween(frame.time_ns, frames_.back().time_ns) <= longest_looked_at_s;
  };
  frames_.erase(frames_.begin(), std::find_if(frames_.begin(), frames_.end(), is_young));
}

bool TimeOffsetFinding::look() {
  const double given_s = 1e-9 * static_cast<double>(unit_.offset_ns);
  const double farthest_s = 1e-9 * static_cast<double>(farthest_time_offset_ns);
  // Samples of the frames looked at alone.
  const std::int64_t begin_ns = frames_.front().time_ns + unit_.offset_ns - 2 * farthest_time_offset_ns;
  const std::optional<TimeOffsetEstimate> estimate =
      estimateTimeOffset(frames_, samplesSince(samples_, begin_ns), unit_, given_s, farthest_s);
  if (!estimate || estimate->seconds < shortest_looked_at_s || !(estimate->sigma_s < known_offset_s)) return false;
  if (!isToChange(*estimate)) return false;
  // Frames were posed in a map that the gyroscope has bent towards the offset that was.
  const double now_s = 1e-9 * static_cast<double>(found_ ? found_->offset_ns : unit_.offset_ns);
  if (std::abs(estimate->offset_s - now_s) > bends_s) frames_.clear();
  found_ = FoundTimeOffset{std::llround(1e9 * estimate->offset_s), estimate->sigma_s};
  steady_ = 0;
  return true;
}

bool TimeOffsetFinding::isToChange(const TimeOffsetEstimate& estimate) {
  const std::int64_t now_ns = found_ ? found_->offset_ns : unit_.offset_ns;
  const double change_s = estimate.offset_s - 1e-9 * static_cast<double>(now_ns);
  if (estimate.sigma_s < well_known_offset_s) ++steady_;
  if (found_) return std::abs(change_s) > std::max(too_little_s, estimate.sigma_s);
  const bool says_so = std::abs(change_s) > std::max(least_s, least_sigmas * estimate.sigma_s);
  const bool agrees =
      agreeing_ > 0 && std::abs(change_s - last_s_) < std::max(agreement_s, alike_offsets * std::abs(change_s));
  agreeing_ = !says_so ? 0 : agrees ? agreeing_ + 1 : 1;
  last_s_ = change_s;
  if (says_so) steady_ = 0;
  return agreeing_ >= agreeing_looks;
}

}  // namespace edgeslam
