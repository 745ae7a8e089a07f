#include "drivers/libcamera/manager.h"

#include <atomic>
#include <cstdlib>
#include <system_error>

namespace edgeslam {
namespace {

std::atomic<bool>& managerExists() {
  static std::atomic<bool> exists{false};
  return exists;
}

// DRM's codes, by which libcamera knows formats: RGB888 has blue in the first byte.
const char* drmCode(PixelFormat format) {
  switch (format) {
    case PixelFormat::grey:
      return "R8  ";
    case PixelFormat::y10:
      return "R10 ";
    case PixelFormat::y12:
      return "R12 ";
    case PixelFormat::y16:
      return "R16 ";
    case PixelFormat::nv12:
      return "NV12";
    case PixelFormat::nv21:
      return "NV21";
    case PixelFormat::yu12:
      return "YU12";
    case PixelFormat::yuyv:
      return "YUYV";
    case PixelFormat::uyvy:
      return "UYVY";
    case PixelFormat::mjpeg:
      return "MJPG";
    case PixelFormat::rgb24:
      return "BG24";
    case PixelFormat::bgr24:
      return "RG24";
  }
  return "    ";
}

}  // namespace

Manager::Manager() {
  if (managerExists().exchange(true)) {
    problem_ = "another libcamera camera is open in this program";
    return;
  }
  setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", 0);  // else it tells its version at each start
  manager_ = std::make_unique<libcamera::CameraManager>();
  if (const int error = manager_->start(); error < 0) {
    problem_ = "libcamera does not start: " + std::generic_category().message(-error);
    manager_.reset();
    managerExists() = false;
  }
}

Manager::~Manager() {
  if (!manager_) return;
  manager_->stop();
  manager_.reset();
  managerExists() = false;
}

std::optional<PixelFormat> knownFormat(const libcamera::PixelFormat& format) {
  for (const PixelFormat known : pixel_formats) {
    if (libcameraFormat(known) == format) return known;
  }
  return std::nullopt;
}

libcamera::PixelFormat libcameraFormat(PixelFormat format) {
  std::uint32_t code = 0;
  const char* const text = drmCode(format);
  for (int i = 3; i >= 0; --i) code = code << 8 | static_cast<unsigned char>(text[i]);
  return libcamera::PixelFormat(code);
}

}  // namespace edgeslam
