// The numbers that a driver gives its frames, 32 bits that wrap around, as numbers over the whole stream.
#pragma once

#include <cstdint>

namespace edgeslam {

class SequenceCounter {
 public:
  struct Numbered {
    std::int64_t sequence = 0;     // from 0 at the first frame, lost ones included
    std::int64_t lost_before = 0;  // since the frame before
  };

  // `number` of the next frame that came. Drivers that never count lose nothing that could be told, and neither do
  // those that begin anew: a step of 0 or back counts as the next frame.
  Numbered add(std::uint32_t number) {
    const std::uint32_t step = number - last_number_;
    const std::int64_t lost = has_last_ && step != 0 && step < (std::uint32_t{1} << 31) ? std::int64_t{step} - 1 : 0;
    sequence_ = has_last_ ? sequence_ + 1 + lost : 0;
    last_number_ = number;
    has_last_ = true;
    return {sequence_, lost};
  }

 private:
  bool has_last_ = false;
  std::uint32_t last_number_ = 0;
  std::int64_t sequence_ = 0;
};

}  // namespace edgeslam
