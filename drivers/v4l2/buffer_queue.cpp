#include "drivers/v4l2/buffer_queue.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

namespace edgeslam {
namespace {

// A v4l2_buffer with the planes that it points to.
struct PlanarBuffer {
  v4l2_buffer buffer{};
  v4l2_plane planes[VIDEO_MAX_PLANES]{};

  PlanarBuffer(const CaptureDevice& device, std::uint32_t index) {
    buffer.index = index;
    buffer.type = device.bufferType();
    buffer.memory = V4L2_MEMORY_MMAP;
    if (device.multi_planar) {
      buffer.m.planes = planes;
      buffer.length = VIDEO_MAX_PLANES;
    }
  }
  PlanarBuffer(const PlanarBuffer&) = delete;
  PlanarBuffer& operator=(const PlanarBuffer&) = delete;
};

V4l2Problem problem(const CaptureDevice& device, const char* what, int error) {
  return {device.path + ": " + what + ": " + errorText(error), mayHeal(error)};
}

}  // namespace

BufferQueue::~BufferQueue() {
  int type = static_cast<int>(device_.bufferType());
  if (streaming_) device_.device.control(VIDIOC_STREAMOFF, &type);
  for (const Mapping& mapping : mappings_) device_.device.system().unmap(mapping.memory, mapping.length);
  v4l2_requestbuffers none{};
  none.type = device_.bufferType();
  none.memory = V4L2_MEMORY_MMAP;
  if (requested_) device_.device.control(VIDIOC_REQBUFS, &none);
}

V4l2Problem BufferQueue::start(int count) {
  v4l2_requestbuffers request{};
  request.count = static_cast<std::uint32_t>(std::clamp(count, 2, VIDEO_MAX_FRAME));
  request.type = device_.bufferType();
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_.device.control(VIDIOC_REQBUFS, &request); error < 0) {
    return problem(device_, "gives no buffers", error);
  }
  requested_ = true;
  if (request.count < 2 || request.count > VIDEO_MAX_FRAME) {
    return {device_.path + ": gives " + std::to_string(request.count) + " buffers, at least 2 are needed", true};
  }
  for (std::uint32_t i = 0; i < request.count; ++i) {
    if (V4l2Problem failed = mapBuffer(i); !failed.text.empty()) return failed;
  }
  for (std::uint32_t i = 0; i < request.count; ++i) {
    if (const int error = give(i); error < 0) return problem(device_, "does not take a buffer", error);
  }
  int type = static_cast<int>(device_.bufferType());
  if (const int error = device_.device.control(VIDIOC_STREAMON, &type); error < 0) {
    V4l2Problem failed = problem(device_, "does not start to stream", error);
    failed.may_heal = true;  // drivers answer EINVAL and EPIPE also for what passes
    return failed;
  }
  streaming_ = true;
  return {};
}

V4l2Problem BufferQueue::mapBuffer(std::uint32_t index) {
  PlanarBuffer query(device_, index);
  if (const int error = device_.device.control(VIDIOC_QUERYBUF, &query.buffer); error < 0) {
    return problem(device_, "does not describe its buffers", error);
  }
  const std::size_t length = device_.multi_planar ? query.planes[0].length : query.buffer.length;
  const std::int64_t offset = device_.multi_planar ? query.planes[0].m.mem_offset : query.buffer.m.offset;
  void* memory = nullptr;
  if (const int error = device_.device.system().map(device_.device.descriptor(), length, offset, &memory); error < 0) {
    return problem(device_, "its buffers cannot be mapped", error);
  }
  mappings_.push_back({memory, length});
  return {};
}

int BufferQueue::take(FilledBuffer& buffer) {
  PlanarBuffer taken(device_, 0);
  if (const int error = device_.device.control(VIDIOC_DQBUF, &taken.buffer); error < 0) return error;
  if (taken.buffer.index >= mappings_.size()) return -EIO;  // a driver gone wrong
  const Mapping& mapping = mappings_[taken.buffer.index];
  // Where the data of a plane begin; only the multi-planar interface tells.
  const std::size_t offset =
      device_.multi_planar ? std::min<std::size_t>(taken.planes[0].data_offset, mapping.length) : 0;
  const std::size_t used = device_.multi_planar ? taken.planes[0].bytesused : taken.buffer.bytesused;
  buffer.index = taken.buffer.index;
  buffer.data = static_cast<const std::uint8_t*>(mapping.memory) + offset;
  buffer.size = std::min(used, mapping.length) - std::min(offset, std::min(used, mapping.length));
  buffer.flags = taken.buffer.flags;
  buffer.sequence = taken.buffer.sequence;
  buffer.stamp_s = taken.buffer.timestamp.tv_sec;
  buffer.stamp_us = taken.buffer.timestamp.tv_usec;
  return 0;
}

int BufferQueue::give(std::uint32_t index) {
  PlanarBuffer given(device_, index);
  return device_.device.control(VIDIOC_QBUF, &given.buffer);
}

}  // namespace edgeslam
