#include "service/memory_reserve.h"

#include <sys/mman.h>

#include <atomic>
#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

struct Reserve {
  std::atomic<void*> memory{nullptr};  // null: there is none any more
  std::size_t bytes = 0;
};

// The handler of `new` has no other way to it.
Reserve& theReserve() {
  static Reserve reserve;
  return reserve;
}

// False where there is none: the program's memory is at its end.
bool useReserve() noexcept {
  Reserve& reserve = theReserve();
  void* memory = reserve.memory.exchange(nullptr);
  return memory != nullptr && ::munmap(memory, reserve.bytes) == 0;
}

void onNoMemory() {
  if (!useReserve()) throw std::bad_alloc();
}

// OpenCV's images, which are not made by `new`.
class ImagesOfReserve : public cv::MatAllocator {
 public:
  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* step,
                         cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    try {
      return usual_.allocate(dimensions, sizes, type, data, step, flags, usage);
    } catch (const cv::Exception&) {
      if (!useReserve()) throw;
    }
    return usual_.allocate(dimensions, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return usual_.allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override { usual_.deallocate(data); }

 private:
  cv::MatAllocator& usual_ = *cv::Mat::getStdAllocator();
};

}  // namespace

MemoryReserve::MemoryReserve(std::size_t bytes)
    : images_(std::make_unique<ImagesOfReserve>()), images_before_(cv::Mat::getDefaultAllocator()) {
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  theReserve().bytes = bytes;
  theReserve().memory = memory;
  cv::Mat::setDefaultAllocator(images_.get());
  handler_before_ = std::set_new_handler(onNoMemory);
}

MemoryReserve::~MemoryReserve() {
  std::set_new_handler(handler_before_);
  cv::Mat::setDefaultAllocator(images_before_);
  useReserve();
}

bool MemoryReserve::isUsed() const { return theReserve().memory == nullptr; }

}  // namespace edgeslam
