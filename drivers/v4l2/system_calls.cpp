#include "drivers/v4l2/system_calls.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>

namespace edgeslam {
namespace {

class Kernel : public SystemCalls {
 public:
  int openFile(const char* path) override { return answer(open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC)); }
  void closeFile(int descriptor) override { close(descriptor); }
  std::uint64_t deviceNumber(int descriptor) override {
    struct stat file {};
    return fstat(descriptor, &file) == 0 ? file.st_rdev : 0;
  }
  int control(int descriptor, unsigned long request, void* argument) override {
    return answer(ioctl(descriptor, request, argument));
  }
  int map(int descriptor, std::size_t length, std::int64_t offset, void** memory) override {
    *memory = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, offset);
    return *memory == MAP_FAILED ? -errno : 0;
  }
  void unmap(void* memory, std::size_t length) override { munmap(memory, length); }
  int wait(pollfd* descriptor, int timeout_ms) override { return answer(poll(descriptor, 1, timeout_ms)); }
  std::int64_t now_ns() override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
  }

 private:
  static int answer(int result) { return result < 0 ? -errno : result; }
};

}  // namespace

SystemCalls& kernel() {
  static Kernel calls;
  return calls;
}

int Device::control(unsigned long request, void* argument) const {
  for (int attempt = 0; attempt < 100; ++attempt) {
    const int result = system_->control(descriptor_, request, argument);
    if (result != -EINTR) return result;
  }
  return -EINTR;
}

}  // namespace edgeslam
