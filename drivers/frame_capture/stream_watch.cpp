#include "drivers/frame_capture/stream_watch.h"

#include <algorithm>

namespace edgeslam {

void StreamWatch::opened(std::int64_t now_ns, std::int64_t frame_interval_ns) {
  open_ = true;
  has_frame_ = false;
  opened_ns_ = last_good_ns_ = last_sign_of_life_ns_ = now_ns;
  frame_interval_ns_ = frame_interval_ns;
}

void StreamWatch::gotFrame(std::int64_t now_ns) {
  has_frame_ = true;
  last_good_ns_ = last_sign_of_life_ns_ = now_ns;
  if (now_ns - opened_ns_ >= policy_.healthy_ns) wait_ns_ = policy_.first_wait_ns;
}

void StreamWatch::gotDamagedFrame(std::int64_t now_ns) { last_sign_of_life_ns_ = now_ns; }

void StreamWatch::failed(std::int64_t now_ns) {
  open_ = false;
  try_at_ns_ = now_ns + wait_ns_;
  wait_ns_ = std::min(2 * wait_ns_, policy_.longest_wait_ns);
}

std::int64_t StreamWatch::quietTime() const {
  if (frame_interval_ns_ <= 0) return policy_.unknown_interval_quiet_ns;
  return std::max(policy_.shortest_quiet_ns,
                  static_cast<std::int64_t>(policy_.quiet_intervals * static_cast<double>(frame_interval_ns_)));
}

std::int64_t StreamWatch::frozenAt() const {
  const std::int64_t only_damaged_at = last_good_ns_ + std::max(policy_.only_damaged_ns, quietTime());
  if (!has_frame_) return std::max(last_good_ns_ + policy_.first_frame_ns, only_damaged_at);
  return std::min(last_sign_of_life_ns_ + quietTime(), only_damaged_at);
}

}  // namespace edgeslam
