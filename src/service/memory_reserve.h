// Memory that is kept for the end: where the program's runs out, what asked for more gets this, and the program can
// save what it has and end.
#pragma once

#include <cstddef>

namespace edgeslam {

// At most one at a time. For all that takes its memory from malloc or one of its kin, in any thread: `new`, images,
// matrices, libraries. A program that has one brings its own malloc, which asks the C library's.
class MemoryReserve {
 public:
  // Enough to write a map of some hundred keyframes.
  static constexpr std::size_t usual_bytes = std::size_t{32} << 20;

  // Throws std::bad_alloc where there is not even that.
  explicit MemoryReserve(std::size_t bytes = usual_bytes);
  ~MemoryReserve();
  MemoryReserve(const MemoryReserve&) = delete;
  MemoryReserve& operator=(const MemoryReserve&) = delete;
  MemoryReserve(MemoryReserve&&) = delete;
  MemoryReserve& operator=(MemoryReserve&&) = delete;

  // Memory ran out, and there is no more after this: end.
  bool isUsed() const;
};

}  // namespace edgeslam
