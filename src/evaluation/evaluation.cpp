#include "evaluation/evaluation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <string>
#include <tuple>
#include <utility>

#include "edgeslam/input_error.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double largest_interval_s = 1e9;

std::int64_t toNanoseconds(double seconds, const char* name) {
  if (!(seconds >= 0 && seconds <= largest_interval_s)) {
    throw InputError(std::string("the ") + name + " must be 0 to 1e9 seconds, it is " + std::to_string(seconds));
  }
  return std::llround(1e9 * seconds);
}

ErrorStatistics statistics(std::vector<double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  const double count = static_cast<double>(errors.size());
  std::sort(errors.begin(), errors.end());
  result.min = errors.front();
  result.max = errors.back();
  result.median = 0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  double squares = 0, deviations = 0;
  for (const double error : errors) {
    squares += error * error;
    deviations += (error - result.mean) * (error - result.mean);
  }
  result.rmse = std::sqrt(squares / count);
  result.standard_deviation = std::sqrt(deviations / count);
  return result;
}

// The pose nearest in time; the earlier one of two that are equally near.
std::size_t nearestIndex(const Trajectory& trajectory, std::int64_t time_ns) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), time_ns,
                       [](const StampedPose& stamped, std::int64_t time) { return stamped.time_ns < time; });
  if (after == trajectory.begin()) return 0;
  const std::size_t index = static_cast<std::size_t>(after - trajectory.begin());
  if (after == trajectory.end()) return index - 1;
  return time_ns - trajectory[index - 1].time_ns <= after->time_ns - time_ns ? index - 1 : index;
}

struct IndexPair {
  std::size_t estimate = 0;
  std::size_t reference = 0;
};

// Reference poses in order of their distance in time to one estimated pose.
class NeighboursInTime {
 public:
  NeighboursInTime(const Trajectory& reference, std::int64_t time_ns)
      : reference_(&reference), time_ns_(time_ns), later_(firstNotBefore(reference, time_ns)), earlier_(later_) {}

  struct Neighbour {
    std::int64_t distance_ns = 0;
    std::size_t index = 0;
  };

  std::optional<Neighbour> next() {
    const bool has_earlier = earlier_ > 0, has_later = later_ < reference_->size();
    if (!has_earlier && !has_later) return std::nullopt;
    const std::int64_t to_earlier = has_earlier ? time_ns_ - (*reference_)[earlier_ - 1].time_ns : 0;
    const std::int64_t to_later = has_later ? (*reference_)[later_].time_ns - time_ns_ : 0;
    if (has_earlier && (!has_later || to_earlier <= to_later)) return Neighbour{to_earlier, --earlier_};
    return Neighbour{to_later, later_++};
  }

 private:
  static std::size_t firstNotBefore(const Trajectory& reference, std::int64_t time_ns) {
    const auto found =
        std::lower_bound(reference.begin(), reference.end(), time_ns,
                         [](const StampedPose& stamped, std::int64_t time) { return stamped.time_ns < time; });
    return static_cast<std::size_t>(found - reference.begin());
  }

  const Trajectory* reference_;
  std::int64_t time_ns_;
  std::size_t later_;    // the next candidate at or after the time
  std::size_t earlier_;  // one past the next candidate before it
};

// Pairs in order of time distance, nearest first, each pose in at most one pair.
std::vector<IndexPair> associate(const Trajectory& estimate, const Trajectory& reference, std::int64_t tolerance_ns) {
  using Candidate = std::tuple<std::int64_t, std::size_t, std::size_t>;  // distance, estimate, reference
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
  std::vector<NeighboursInTime> neighbours;
  const auto pushNext = [&](std::size_t index) {
    const auto neighbour = neighbours[index].next();
    if (neighbour && neighbour->distance_ns <= tolerance_ns) {
      candidates.emplace(neighbour->distance_ns, index, neighbour->index);
    }
  };
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    neighbours.emplace_back(reference, estimate[i].time_ns);
    pushNext(i);
  }
  std::vector<char> taken(reference.size(), 0);
  std::vector<IndexPair> pairs;
  while (!candidates.empty()) {
    const auto [distance, estimate_index, reference_index] = candidates.top();
    candidates.pop();
    if (taken[reference_index]) {
      pushNext(estimate_index);
      continue;
    }
    taken[reference_index] = 1;
    pairs.push_back({estimate_index, reference_index});
  }
  std::sort(pairs.begin(), pairs.end(), [](const IndexPair& a, const IndexPair& b) { return a.estimate < b.estimate; });
  return pairs;
}

bool isWithin(std::int64_t a_ns, std::int64_t b_ns, std::int64_t tolerance_ns) {
  return std::abs(a_ns - b_ns) <= tolerance_ns;
}

std::int64_t medianStep(const Trajectory& trajectory) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back(trajectory[i].time_ns - trajectory[i - 1].time_ns);
  }
  return medianOr(std::int64_t{0}, std::move(steps));
}

}  // namespace

AbsoluteError absoluteError(const Trajectory& estimate, const Trajectory& reference, Alignment alignment,
                            double tolerance_s) {
  const std::vector<IndexPair> pairs = associate(estimate, reference, toNanoseconds(tolerance_s, "tolerance"));
  const std::size_t needed = alignment == Alignment::none ? 1 : 3;
  if (pairs.size() < needed) {
    throw InputError("only " + std::to_string(pairs.size()) + " of " + std::to_string(estimate.size()) +
                     " estimated poses have a reference pose within " + std::to_string(tolerance_s) + " s, at least " +
                     std::to_string(needed) + " are needed; are these the same clock and sequence?");
  }
  std::vector<Eigen::Vector3d> from, to;
  for (const IndexPair& pair : pairs) {
    from.push_back(estimate[pair.estimate].world_T_camera.translation);
    to.push_back(reference[pair.reference].world_T_camera.translation);
  }
  AbsoluteError result;
  result.pairs = static_cast<int>(pairs.size());
  if (alignment != Alignment::none) {
    result.reference_T_estimate = alignHorn(from, to, alignment == Alignment::similarity);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    result.times_ns.push_back(estimate[pairs[i].estimate].time_ns);
    result.aligned.emplace_back(result.reference_T_estimate * from[i]);
    result.errors.push_back((result.aligned.back() - to[i]).norm());
  }
  result.translation = statistics(result.errors);
  return result;
}

RelativeError relativeError(const Trajectory& estimate, const Trajectory& reference, Alignment alignment,
                            double delta_s, double tolerance_s) {
  const std::int64_t delta_ns = toNanoseconds(delta_s, "interval of the relative error");
  if (delta_ns <= 0) throw InputError("the interval of the relative error must be greater than 0 seconds");
  const std::int64_t tolerance_ns = toNanoseconds(tolerance_s, "tolerance");
  const double scale = absoluteError(estimate, reference, alignment, tolerance_s).reference_T_estimate.scale;

  std::vector<double> translations, rotations;
  for (std::size_t first = 0; first < estimate.size(); ++first) {
    const std::size_t second = nearestIndex(estimate, estimate[first].time_ns + delta_ns);
    if (second <= first || second + 1 == estimate.size()) continue;
    const StampedPose& reference_first = reference[nearestIndex(reference, estimate[first].time_ns)];
    const StampedPose& reference_second = reference[nearestIndex(reference, estimate[second].time_ns)];
    if (!isWithin(reference_first.time_ns, estimate[first].time_ns, tolerance_ns) ||
        !isWithin(reference_second.time_ns, estimate[second].time_ns, tolerance_ns)) {
      continue;
    }
    // The TUM tool compares the motions backwards, the first pose seen from the second.
    Pose estimated_motion = estimate[second].world_T_camera.inverse() * estimate[first].world_T_camera;
    estimated_motion.translation *= scale;
    const Pose true_motion = reference_second.world_T_camera.inverse() * reference_first.world_T_camera;
    const Pose error = estimated_motion.inverse() * true_motion;
    translations.push_back(error.translation.norm());
    rotations.push_back(rotationLog(error.rotation).norm());
  }
  RelativeError result;
  result.pairs = static_cast<int>(translations.size());
  result.translation = statistics(std::move(translations));
  result.rotation = statistics(std::move(rotations));
  return result;
}

Coverage coverage(const Trajectory& estimate, const Trajectory& reference, double tolerance_s) {
  if (estimate.empty() || reference.empty()) throw InputError("a trajectory without poses covers nothing");
  const std::int64_t tolerance_ns = toNanoseconds(tolerance_s, "tolerance");
  const std::int64_t start_ns = estimate.front().time_ns;
  Coverage result;
  result.start_s = 1e-9 * static_cast<double>(start_ns - reference.front().time_ns);

  std::size_t posed = 0, after_start = 0;
  for (const StampedPose& stamped : reference) {
    if (stamped.time_ns >= start_ns - tolerance_ns) ++after_start;
    if (isWithin(estimate[nearestIndex(estimate, stamped.time_ns)].time_ns, stamped.time_ns, tolerance_ns)) ++posed;
  }
  result.pose_share = static_cast<double>(posed) / static_cast<double>(reference.size());
  if (after_start > 0) result.pose_share_after_start = static_cast<double>(posed) / static_cast<double>(after_start);

  const std::int64_t begin = reference.front().time_ns, end = reference.back().time_ns;
  const double largest_step = 3.0 * static_cast<double>(medianStep(estimate));
  double covered_ns = 0;
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const std::int64_t from = estimate[i - 1].time_ns, to = estimate[i].time_ns;
    if (static_cast<double>(to - from) > largest_step) continue;
    covered_ns += static_cast<double>(std::max<std::int64_t>(0, std::min(to, end) - std::max(from, begin)));
  }
  if (end > begin) result.time_share = covered_ns / static_cast<double>(end - begin);
  return result;
}

}  // namespace edgeslam
