#include "system/faults/faulty_camera.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "unit/v4l2/fake_driver.h"

namespace {

using edgeslam::FakeDriver;

constexpr std::int64_t second_ns = 1'000'000'000, frame_ns = second_ns / 30;
constexpr std::size_t image_bytes = std::size_t{edgeslam::faulty_camera_width} * edgeslam::faulty_camera_height;
constexpr std::uint32_t grey = v4l2_fourcc('G', 'R', 'E', 'Y'), mjpeg = v4l2_fourcc('M', 'J', 'P', 'G');
constexpr const char* jpeg_start = "\xff\xd8";

std::int64_t steady_ns() {
  timespec now{};
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return now.tv_sec * second_ns + now.tv_nsec;
}

std::string contentOf(const char* variable) {
  const char* path = std::getenv(variable);
  std::ifstream file(path ? path : "", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// In a JPEG's data a byte 0xff is never followed by such a marker.
std::vector<std::string> imagesOf(const std::string& content) {
  std::vector<std::string> images;
  const bool are_jpeg = content.rfind(jpeg_start, 0) == 0;
  for (std::size_t at = 0; at < content.size(); at += images.back().size()) {
    const std::size_t end = content.find(std::string("\xff\xd9") + jpeg_start, at);
    images.push_back(content.substr(at, !are_jpeg ? image_bytes : end == std::string::npos ? end : end + 2 - at));
  }
  return images;
}

class PlayingCamera : public FakeDriver {
 public:
  PlayingCamera() {
    const bool sends_jpeg = !images_.empty() && images_.front().rfind(jpeg_start, 0) == 0;
    buffer_bytes_ = image_bytes * (sends_jpeg ? 2 : 1);
    formats = {{sends_jpeg ? mjpeg : grey, {{edgeslam::faulty_camera_width, edgeslam::faulty_camera_height, {30}}}}};
  }

  // What should have happened by now.
  void play() {
    const std::int64_t now_ns = steady_ns();
    if (start_ns_ == 0) start_ns_ = now_ns;
    for (; start_ns_ + next_ * frame_ns <= now_ns; ++next_) {
      takeTrouble();
      deliver(next_);
    }
  }

  int wait(pollfd* descriptor, int timeout_ms) override {
    const std::int64_t end_ns = steady_ns() + std::int64_t{timeout_ms} * 1'000'000;
    while (true) {
      play();
      const int ready = FakeDriver::wait(descriptor, 0);
      if (ready != 0 || steady_ns() >= end_ns) return ready;
      usleep(1000);
    }
  }

 private:
  void takeTrouble() {
    std::string word = contentOf(edgeslam::faulty_camera_trouble);
    if (word == trouble_) return;
    trouble_ = word;
    trouble_since_ = next_;
    const bool other_size = trouble_ == "size";
    plugged = trouble_ != "gone";
    if (!plugged || other_size) streaming = false;
    formats.front().sizes.front().width = edgeslam::faulty_camera_width / (other_size ? 2 : 1);
    formats.front().sizes.front().height = edgeslam::faulty_camera_height / (other_size ? 2 : 1);
    if (other_size) wait_failures.push_back(POLLERR | POLLHUP);
  }

  void deliver(std::int64_t frame) {
    if (trouble_ == "frozen" || trouble_ == "gone") return;
    if (trouble_ == "swapped") return deliverSwapped(frame);
    if (trouble_ == "bursts") return deliverBurst(frame);
    fillWith(frame);
    if (trouble_ == "twice") fillWith(frame);
  }
  void deliverSwapped(std::int64_t frame) {
    if (frame % 2 == 0) return;
    fillWith(frame);
    fillWith(frame - 1);
  }
  void deliverBurst(std::int64_t frame) {
    for (std::int64_t late = frame - 5; frame % 6 == 5 && late <= frame; ++late) fillWith(late);
  }

  void fillWith(std::int64_t frame) {
    const std::int64_t shown = trouble_ == "repeated" ? trouble_since_ : frame;
    const auto count = static_cast<std::int64_t>(images_.size());
    const std::int64_t place = shown % (2 * count - 2);
    const auto image = static_cast<std::size_t>(place < count ? place : 2 * count - 2 - place);
    const std::int64_t stamp_ns = start_ns_ + frame * frame_ns - (trouble_ == "past" ? 3 * second_ns : 0);
    std::string buffer = images_[image];
    const std::size_t filled = buffer.size() / (trouble_ == "short" ? 2 : 1);
    buffer.resize(buffer_bytes_);
    fill(reinterpret_cast<const std::uint8_t*>(buffer.data()), static_cast<std::uint32_t>(frame), stamp_ns, 0,
         static_cast<int>(buffer_bytes_ - filled));
  }

  const std::vector<std::string> images_ = imagesOf(contentOf(edgeslam::faulty_camera_frames));
  std::size_t buffer_bytes_ = 0;
  std::int64_t start_ns_ = 0, next_ = 0, trouble_since_ = 0;
  std::string trouble_;
};

PlayingCamera& camera() {
  static PlayingCamera playing;
  return playing;
}

int camera_file = -1;  // a descriptor that nothing else has

int answer(int result) {
  if (result >= 0) return result;
  errno = -result;
  return -1;
}

int openCamera() {
  camera().play();
  const int opened = camera().openFile(edgeslam::faulty_camera_device);
  if (opened < 0) return answer(opened);
  return camera_file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, "/dev/null", O_RDWR | O_CLOEXEC));
}

template <typename Function>
Function* original(Function* /*replaced*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define EDGESLAM_REPLACES extern "C" __attribute__((visibility("default")))

EDGESLAM_REPLACES int open(const char* path, int flags, ...) {
  if (std::strcmp(path, edgeslam::faulty_camera_device) == 0) return openCamera();
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

EDGESLAM_REPLACES int close(int file) {
  if (file == camera_file && file >= 0) {
    camera().closeFile(file);
    camera_file = -1;
  }
  return static_cast<int>(syscall(SYS_close, file));
}

EDGESLAM_REPLACES int ioctl(int file, unsigned long request, ...) noexcept {
  va_list more;
  va_start(more, request);
  void* argument = va_arg(more, void*);
  va_end(more);
  if (file != camera_file) return static_cast<int>(syscall(SYS_ioctl, file, request, argument));
  return answer(camera().control(file, request, argument));
}

EDGESLAM_REPLACES void* mmap(void* address, size_t length, int protection, int flags, int file, off_t offset) noexcept {
  static auto* const real = original(&mmap, "mmap");
  if (file < 0 || file != camera_file) return real(address, length, protection, flags, file, offset);
  void* memory = nullptr;
  return answer(camera().map(file, length, offset, &memory)) < 0 ? MAP_FAILED : memory;
}

EDGESLAM_REPLACES int munmap(void* address, size_t length) noexcept {
  static auto* const real = original(&munmap, "munmap");
  if (camera_file < 0 || camera().mapped.count(address) == 0) return real(address, length);
  camera().unmap(address, length);
  return 0;
}

EDGESLAM_REPLACES int poll(pollfd* files, nfds_t count, int timeout_ms) {
  static auto* const real = original(&poll, "poll");
  if (count != 1 || files->fd < 0 || files->fd != camera_file) return real(files, count, timeout_ms);
  return answer(camera().wait(files, timeout_ms));
}
