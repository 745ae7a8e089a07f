#include "inertia/saturation_watch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "files/format_text.h"

namespace edgeslam {
namespace {

// By chance a unit with some noise does not give its largest value so often in a row.
constexpr int most_repeated = 3;
// No unit's range ends before these: what is steady below them is motion.
constexpr double least_range_rate = 2, least_range_force = 15;  // [rad/s], [m/s^2]
constexpr std::int64_t told_for_ns = 10'000'000'000;

bool isRate(std::size_t axis) { return axis < 3; }

double valueOf(const InertialSample& sample, std::size_t axis) {
  return isRate(axis) ? sample.rate(static_cast<Eigen::Index>(axis))
                      : sample.force(static_cast<Eigen::Index>(axis - 3));
}

}  // namespace

void SaturationWatch::add(const InertialSample& sample) {
  time_ns_ = sample.time_ns;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const double value = valueOf(sample, i), size = std::abs(value);
    const bool is_at_end = size >= axis.largest && size >= (isRate(i) ? least_range_rate : least_range_force);
    axis.repeated = is_at_end ? (value == axis.last ? axis.repeated + 1 : 1) : 0;
    axis.largest = std::max(axis.largest, size);
    axis.last = value;
    if (axis.repeated > most_repeated) axis.cut_ns = time_ns_;
  }
}

std::string SaturationWatch::problem() const {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    if (!axis.cut_ns || time_ns_ - *axis.cut_ns > told_for_ns) continue;
    return formatted("the %s is cut off at %.3g %s along its %c axis: set a larger range, or damp what shakes it",
                     isRate(i) ? "gyroscope" : "accelerometer", axis.largest, isRate(i) ? "rad/s" : "m/s^2",
                     "xyz"[i % 3]);
  }
  return "";
}

std::string saturationProblem(const std::vector<InertialSample>& samples) {
  SaturationWatch watch;
  for (const InertialSample& sample : samples) {
    watch.add(sample);
    if (std::string problem = watch.problem(); !problem.empty()) return problem;
  }
  return "";
}

}  // namespace edgeslam
