// Tells what is wrong with what an inertial unit gives, from the data alone: its units, its range, gaps, and how it
// comes.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "inertia/inertial_unit.h"
#include "inertia/sample_gap_watch.h"
#include "inertia/saturation_watch.h"
#include "samples/arrival_watch.h"

namespace edgeslam {

// What no robot does all the time tells that samples are in other units: of the medians of the specific force's length
// [m/s^2] and of the rate's [rad/s]. Empty where nothing is wrong.
std::string unitsProblem(double median_force, double median_rate);

class InertialWatch {
 public:
  // `offset_ns`: of the unit's clock from the camera's.
  explicit InertialWatch(std::int64_t offset_ns) : arrivals_({offset_ns, 0.02, 50, 100}) {}

  // In the order in which they come, a frame after the samples that were there before it; times by its own clock.
  void add(const InertialSample& sample);
  void addFrame(std::int64_t time_ns) { arrivals_.addFrame(time_ns); }

  // In a line, of what came lately; empty where nothing is wrong, or nothing can be said yet.
  std::string problem() const;

 private:
  ArrivalWatch arrivals_;
  SampleGapWatch gaps_;
  SaturationWatch saturation_;
  std::array<double, ArrivalWatch::window> rates_{}, forces_{};  // rings: lengths [rad/s], [m/s^2]
  std::size_t count_ = 0;                                        // ever
};

}  // namespace edgeslam
