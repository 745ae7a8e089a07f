// The system calls that the driver makes, so that tests can stand in for the kernel.
#pragma once

#include <poll.h>

#include <cstddef>
#include <cstdint>

namespace edgeslam {

// Every call answers with 0 or what it makes, or with a negative errno.
class SystemCalls {
 public:
  virtual ~SystemCalls() = default;
  virtual int openFile(const char* path) = 0;  // for reading and writing, non-blocking
  virtual void closeFile(int descriptor) = 0;
  virtual std::uint64_t deviceNumber(int descriptor) = 0;  // of an open device file, as makedev(); 0: it is none
  virtual int control(int descriptor, unsigned long request, void* argument) = 0;  // ioctl
  virtual int map(int descriptor, std::size_t length, std::int64_t offset, void** memory) = 0;
  virtual void unmap(void* memory, std::size_t length) = 0;
  virtual int wait(pollfd* descriptor, int timeout_ms) = 0;  // poll for one; its answer as poll's
  virtual std::int64_t now_ns() = 0;                         // CLOCK_MONOTONIC
};

// The kernel's. Lives as long as the program.
SystemCalls& kernel();

// An open device; closed at the end.
class Device {
 public:
  Device(SystemCalls& system, int descriptor) : system_(&system), descriptor_(descriptor) {}
  ~Device() {
    if (descriptor_ >= 0) system_->closeFile(descriptor_);
  }
  Device(Device&& other) noexcept : system_(other.system_), descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  Device& operator=(Device&&) = delete;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // 0 or a negative errno; again where a signal came in between.
  int control(unsigned long request, void* argument) const;
  SystemCalls& system() const { return *system_; }
  int descriptor() const { return descriptor_; }

 private:
  SystemCalls* system_;
  int descriptor_;
};

}  // namespace edgeslam
