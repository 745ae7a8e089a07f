// When a stream counts as frozen, and when to open its camera again: times in, answers out. All times are of one
// monotonic clock, in nanoseconds.
#pragma once

#include <cstdint>

namespace edgeslam {

struct WatchPolicy {
  // A stream is frozen after this many frame intervals without a frame, and not before the shortest time; where the
  // interval is not known, after `unknown_interval_quiet_ns`.
  double quiet_intervals = 4;
  std::int64_t shortest_quiet_ns = 300'000'000;
  std::int64_t unknown_interval_quiet_ns = 450'000'000;
  std::int64_t first_frame_ns = 2'000'000'000;   // that a camera may take to start
  std::int64_t only_damaged_ns = 2'000'000'000;  // damaged frames and no other for as long: it is broken
  // Waits between attempts to open it: the first, doubled each time up to the longest.
  std::int64_t first_wait_ns = 100'000'000;
  std::int64_t longest_wait_ns = 5'000'000'000;
  std::int64_t healthy_ns = 3'000'000'000;  // after streaming for as long, the waits begin anew
};

class StreamWatch {
 public:
  explicit StreamWatch(const WatchPolicy& policy = {}) : policy_(policy), wait_ns_(policy.first_wait_ns) {}

  // What happened. `frame_interval_ns`: 0 where it is not known.
  void opened(std::int64_t now_ns, std::int64_t frame_interval_ns);
  void gotFrame(std::int64_t now_ns);
  void gotDamagedFrame(std::int64_t now_ns);
  // The stream broke, or the camera could not be opened: plans the next attempt.
  void failed(std::int64_t now_ns);

  bool isOpen() const { return open_; }
  // Where it is open: the time at which it will count as frozen unless something comes before.
  std::int64_t frozenAt() const;
  // Where it is not: when to try again, at once at first.
  std::int64_t tryAt() const { return try_at_ns_; }

 private:
  std::int64_t quietTime() const;

  WatchPolicy policy_;
  bool open_ = false;
  bool has_frame_ = false;                 // since it was opened
  std::int64_t opened_ns_ = 0;             //
  std::int64_t last_good_ns_ = 0;          // frame, or opening
  std::int64_t last_sign_of_life_ns_ = 0;  // damaged frames included
  std::int64_t frame_interval_ns_ = 0;
  std::int64_t wait_ns_ = 0;  // before the attempt that follows the next failure
  std::int64_t try_at_ns_ = 0;
};

}  // namespace edgeslam
