// Tells what is wrong with how a sensor's samples come beside the frames, from their time stamps alone: silence,
// another clock, delay, too low a rate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace edgeslam {

struct ArrivalNeeds {
  std::int64_t offset_ns = 0;  // of the sensor's clock from the camera's
  double latest_s = 0.02;      // behind its frame: more, and frames are tracked without
  double least_rate_hz = 50;   // fewer are told ...
  int asked_rate_hz = 100;     // ... and so many are asked for
};

class ArrivalWatch {
 public:
  explicit ArrivalWatch(const ArrivalNeeds& needs) : needs_(needs) {}

  // In the order in which they come, a frame after the samples that were there before it; times by its own clock [ns].
  void add(std::int64_t time_ns) { times_ns_[count_++ % window] = time_ns; }
  void addFrame(std::int64_t time_ns);

  // In a line; empty where nothing is wrong, or nothing can be said yet.
  std::string silence() const;
  bool hasSeenEnough() const { return count_ >= window && frames_with_ >= behind_s_.size(); }
  // Of what came lately, once it hasSeenEnough().
  std::string timingProblem() const;

  static constexpr std::size_t window = 64;  // samples that are looked at

 private:
  ArrivalNeeds needs_;
  std::array<std::int64_t, window> times_ns_{};  // a ring
  std::size_t count_ = 0;                        // ever
  std::size_t count_at_frame_ = 0;               // of the last frame
  std::int64_t first_frame_ns_ = -1, frame_ns_ = -1;
  std::int64_t frame_with_ns_ = -1;    // the last one before which samples came
  std::array<double, 16> behind_s_{};  // a ring: how far the latest sample was behind such frames
  std::size_t frames_with_ = 0;
};

}  // namespace edgeslam
