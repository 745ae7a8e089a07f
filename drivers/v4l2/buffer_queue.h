// The buffers that driver and program pass to and fro, mapped into memory. Not exported as DMA buffers: the pixels are
// read by the processor alone, and mapped they are already where they can be read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/v4l2/capture_device.h"

namespace edgeslam {

struct FilledBuffer {
  std::uint32_t index = 0;
  const std::uint8_t* data = nullptr;  // of the first plane, where the brightness is
  std::size_t size = 0;                // [bytes] that the driver filled, never more than are mapped
  std::uint32_t flags = 0;             // V4L2_BUF_FLAG_...
  std::uint32_t sequence = 0;
  std::int64_t stamp_s = 0, stamp_us = 0;
};

class BufferQueue {
 public:
  // The device must outlive it.
  explicit BufferQueue(const CaptureDevice& device) : device_(device) {}
  // Stops the stream and gives the buffers back.
  ~BufferQueue();
  BufferQueue(const BufferQueue&) = delete;
  BufferQueue& operator=(const BufferQueue&) = delete;

  // Maps `count` buffers (the driver may make it more or fewer), hands them to the driver and starts the stream. The
  // problem's text begins with the device.
  V4l2Problem start(int count);

  // The oldest filled buffer, which is the caller's until give(). 0, -EAGAIN where there is none, or a negative errno.
  int take(FilledBuffer& buffer);
  // 0 or a negative errno.
  int give(std::uint32_t index);

 private:
  struct Mapping {
    void* memory;
    std::size_t length;
  };
  V4l2Problem mapBuffer(std::uint32_t index);

  const CaptureDevice& device_;
  std::vector<Mapping> mappings_;
  bool requested_ = false;
  bool streaming_ = false;
};

}  // namespace edgeslam
