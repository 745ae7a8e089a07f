// Tells what is wrong with what an inertial unit gives, from the data alone: its units, its clock, its gaps.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "inertia/inertial_unit.h"

namespace edgeslam {

// What no robot does all the time tells that samples are in other units: of the medians of the specific force's length
// [m/s^2] and of the rate's [rad/s]. Empty where nothing is wrong.
std::string unitsProblem(double median_force, double median_rate);

class InertialWatch {
 public:
  // `offset_ns`: of the unit's clock from the camera's.
  explicit InertialWatch(std::int64_t offset_ns) : offset_ns_(offset_ns) {}

  // In the order in which they come, a frame after the samples that were there before it; times by its own clock.
  void add(const InertialSample& sample);
  void addFrame(std::int64_t time_ns);

  // In a line, of what came lately; empty where nothing is wrong, or nothing can be said yet.
  std::string problem() const;

 private:
  static constexpr std::size_t window = 64;
  struct Seen {
    std::int64_t time_ns = 0;
    double rate = 0, force = 0;
  };

  std::int64_t offset_ns_;
  std::array<Seen, window> seen_{};  // a ring
  std::size_t count_ = 0;            // ever
  std::size_t count_at_frame_ = 0;   // of the last frame
  std::int64_t first_frame_ns_ = -1, frame_ns_ = -1;
  std::int64_t frame_with_ns_ = -1;    // the last one before which samples came
  std::array<double, 16> behind_s_{};  // a ring: how far the latest sample was behind such frames
  std::size_t frames_with_ = 0;
};

}  // namespace edgeslam
