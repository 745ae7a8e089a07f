#include "service/memory_reserve.h"

#include <sys/mman.h>

#include <atomic>
#include <cerrno>
#include <mutex>
#include <new>

namespace edgeslam {
namespace {

class Reserve {
 public:
  bool isThere() const noexcept { return is_there_.load(); }
  void put(void* memory, std::size_t bytes) noexcept {
    const std::lock_guard<std::mutex> guard(given_);
    memory_ = memory;
    bytes_ = bytes;
    is_there_ = true;
  }
  // Once; whoever comes meanwhile waits until it is given.
  void give() noexcept {
    const std::lock_guard<std::mutex> guard(given_);
    if (!is_there_) return;
    ::munmap(memory_, bytes_);
    is_there_ = false;
  }

 private:
  std::mutex given_;
  std::atomic<bool> is_there_{false};
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

// What is asked for memory has no other way to it.
Reserve& theReserve() noexcept {
  static Reserve reserve;
  return reserve;
}

// Memory by `take`, or null. Another thread may have given the reserve while this one was refused: it is at hand then.
template <typename Take>
void* taken(Take take) noexcept {
  const bool was_there = theReserve().isThere();
  void* memory = take();
  if (memory != nullptr || !was_there) return memory;
  theReserve().give();
  return take();
}

}  // namespace

MemoryReserve::MemoryReserve(std::size_t bytes) {
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  theReserve().put(memory, bytes);
}

MemoryReserve::~MemoryReserve() { theReserve().give(); }

bool MemoryReserve::isUsed() const { return !theReserve().isThere(); }

}  // namespace edgeslam

// The program's functions of this name come before those of the C library, which they call, in shared libraries as
// well. std::set_new_handler would see `new` alone: Eigen's matrices, OpenCV's images and libraries in C go past it.
// The sanitizers have their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__GLIBC__)
#pragma GCC visibility push(default)
extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): the C library's own names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
  return edgeslam::taken([size] { return __libc_malloc(size); });
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  return edgeslam::taken([count, size] { return __libc_calloc(count, size); });
}

// Of a size of 0 it is null, and that is no refusal.
void* realloc(void* memory, std::size_t size) noexcept {
  if (size == 0) return __libc_realloc(memory, size);
  return edgeslam::taken([memory, size] { return __libc_realloc(memory, size); });
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return edgeslam::taken([alignment, size] { return __libc_memalign(alignment, size); });
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  if (alignment == 0 || alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* const found = memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *memory = found;
  return 0;
}

}  // extern "C"
#pragma GCC visibility pop
#endif
