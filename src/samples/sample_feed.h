// Gives a run what a sensor measured beside recorded frames, as the frames come. Of each sample a function timeOf()
// tells its time [ns].
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgeslam {

template <typename Sample>
class SampleFeed {
 public:
  // `samples` must outlive it; their times ascend. `offset_ns`: of the sensor's clock from the camera's.
  explicit SampleFeed(const std::vector<Sample>& samples, std::int64_t offset_ns = 0)
      : samples_(samples), offset_ns_(offset_ns) {}

  // Before each frame: gives what was measured until then, and the first after it, which a frame between two needs.
  template <typename Give>
  void giveUntil(std::int64_t frame_ns, const Give& give) {
    const std::int64_t until_ns = frame_ns + offset_ns_;
    while (next_ < samples_.size() && (next_ == 0 || timeOf(samples_[next_ - 1]) < until_ns)) give(samples_[next_++]);
  }

 private:
  const std::vector<Sample>& samples_;
  std::int64_t offset_ns_;
  std::size_t next_ = 0;
};

}  // namespace edgeslam
