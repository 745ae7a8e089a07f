#include "inertia/inertial_watch.h"

#include <vector>

#include "files/format_text.h"
#include "geometry/median.h"

namespace edgeslam {

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
  arrivals_.add(sample.time_ns);
  gaps_.add(sample.time_ns);
  saturation_.add(sample);
  rates_[count_ % rates_.size()] = sample.rate.norm();
  forces_[count_++ % forces_.size()] = sample.force.norm();
}

std::string InertialWatch::problem() const {
  if (std::string silence = arrivals_.silence(); !silence.empty()) return silence;
  if (!arrivals_.hasSeenEnough()) return "";
  std::vector<double> forces(forces_.begin(), forces_.end()), rates(rates_.begin(), rates_.end());
  std::string wrong = unitsProblem(upperMedian(std::move(forces)), upperMedian(std::move(rates)));
  if (wrong.empty()) wrong = arrivals_.timingProblem();
  if (wrong.empty()) wrong = gaps_.problem();
  return wrong.empty() ? saturation_.problem() : wrong;
}

}  // namespace edgeslam
