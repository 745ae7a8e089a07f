// The buffers of a stream, mapped into memory.
#pragma once

#include <libcamera/framebuffer.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace edgeslam {

class FrameMemory {
 public:
  struct Plane {
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;  // [bytes]
  };

  FrameMemory() = default;
  ~FrameMemory();
  FrameMemory(const FrameMemory&) = delete;
  FrameMemory& operator=(const FrameMemory&) = delete;

  // Maps the first plane, where the brightness is, of each buffer. What went wrong, or an empty text.
  std::string map(const std::vector<std::unique_ptr<libcamera::FrameBuffer>>& buffers);
  // Empty for a buffer that was not mapped.
  Plane firstPlane(const libcamera::FrameBuffer* buffer) const;

 private:
  struct Mapping {
    void* memory;
    std::size_t length;
  };
  std::vector<Mapping> mappings_;
  std::map<const libcamera::FrameBuffer*, Plane> planes_;
};

}  // namespace edgeslam
