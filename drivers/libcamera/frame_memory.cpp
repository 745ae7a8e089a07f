#include "drivers/libcamera/frame_memory.h"

#include <sys/mman.h>

#include <cerrno>
#include <system_error>

namespace edgeslam {

FrameMemory::~FrameMemory() {
  for (const Mapping& mapping : mappings_) munmap(mapping.memory, mapping.length);
}

std::string FrameMemory::map(const std::vector<std::unique_ptr<libcamera::FrameBuffer>>& buffers) {
  for (const std::unique_ptr<libcamera::FrameBuffer>& buffer : buffers) {
    if (buffer->planes().empty()) return "a buffer without planes";
    const libcamera::FrameBuffer::Plane& plane = buffer->planes().front();
    // Planes may share a file at offsets that are no multiples of a page.
    const std::size_t length = std::size_t{plane.offset} + plane.length;
    void* const memory = mmap(nullptr, length, PROT_READ, MAP_SHARED, plane.fd.get(), 0);
    if (memory == MAP_FAILED) return "its buffers cannot be mapped: " + std::generic_category().message(errno);
    mappings_.push_back({memory, length});
    planes_[buffer.get()] = {static_cast<const std::uint8_t*>(memory) + plane.offset, plane.length};
  }
  return "";
}

FrameMemory::Plane FrameMemory::firstPlane(const libcamera::FrameBuffer* buffer) const {
  const auto found = planes_.find(buffer);
  return found == planes_.end() ? Plane{} : found->second;
}

}  // namespace edgeslam
