// The newest value from one thread to another, wait-free: one slot is the writer's, one the reader's, and the third
// changes hands by one atomic exchange.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace edgeslam {

template <typename Value>
class TripleBuffer {
 public:
  // The writer's slot, as it was when the writer last had it.
  Value& writing() { return slots_[writer_]; }
  // Hands it over and takes another one. True where the value before was never read.
  bool publish() {
    const std::uint8_t given = middle_.exchange(static_cast<std::uint8_t>(writer_ | fresh), std::memory_order_acq_rel);
    writer_ = given & index;
    return (given & fresh) != 0;
  }

  // True where there is a newer value, which is then the reader's.
  bool take() {
    if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    reader_ = middle_.exchange(reader_, std::memory_order_acq_rel) & index;
    return true;
  }
  Value& reading() { return slots_[reader_]; }

 private:
  static constexpr std::uint8_t fresh = 4, index = 3;

  std::array<Value, 3> slots_;
  std::uint8_t writer_ = 0;              // the writer's alone
  std::atomic<std::uint8_t> middle_{1};  // a slot, and whether its value is fresh
  std::uint8_t reader_ = 2;              // the reader's alone
};

}  // namespace edgeslam
