#include "drivers/v4l2/capture_device.h"

#include <linux/videodev2.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace edgeslam {
namespace {

// Text of a fixed array that need not end in a zero.
template <std::size_t size>
std::string textOf(const unsigned char (&bytes)[size]) {
  std::string text(bytes, bytes + size);
  text.resize(std::strlen(text.c_str()));
  return text;
}

OpenedDevice problem(const std::string& path, const std::string& text, bool may_heal) {
  return {nullptr, {path + ": " + text, may_heal}, false};
}

OpenedDevice otherDevice(const std::string& path, const std::string& text) {
  return {nullptr, {path + ": " + text, false}, true};
}

}  // namespace

std::uint32_t CaptureDevice::bufferType() const {
  return multi_planar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

std::string errorText(int error) {
  const int code = std::abs(error);
  std::string text = std::generic_category().message(code);
  switch (code) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      text += " (the camera is not plugged in)";
      break;
    case EBUSY:
      text += " (another program uses the camera)";
      break;
    case EACCES:
    case EPERM:
      text += " (add the user to the group video)";
      break;
    case ENOSPC:
      text += " (the USB bus has not enough bandwidth left; a lower rate, a smaller size or MJPEG may do)";
      break;
    default:
      break;
  }
  return text;
}

bool mayHeal(int error) {
  switch (std::abs(error)) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case EBUSY:
    case EIO:
    case EPROTO:
    case EPIPE:
    case ETIMEDOUT:
    case ENOSPC:
    case ENOMEM:
    case EAGAIN:
    case EINTR:
      return true;
    default:
      return false;
  }
}

OpenedDevice openCaptureDevice(SystemCalls& system, const std::string& path) {
  int descriptor = -EINTR;
  for (int attempt = 0; attempt < 100 && descriptor == -EINTR; ++attempt) descriptor = system.openFile(path.c_str());
  if (descriptor < 0) return problem(path, "cannot be opened: " + errorText(descriptor), mayHeal(descriptor));
  auto opened = std::make_unique<CaptureDevice>(CaptureDevice{Device(system, descriptor), path, "", "", "", false});

  v4l2_capability capability{};
  if (const int error = opened->device.control(VIDIOC_QUERYCAP, &capability); error < 0) {
    if (error == -ENOTTY || error == -EINVAL) return otherDevice(path, "is no video device");
    return problem(path, "does not answer: " + errorText(error), mayHeal(error));
  }
  const std::uint32_t can =
      capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps : capability.capabilities;
  opened->card = textOf(capability.card);
  opened->driver = textOf(capability.driver);
  opened->bus = textOf(capability.bus_info);
  opened->multi_planar = (can & V4L2_CAP_VIDEO_CAPTURE) == 0;
  if ((can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) == 0) {
    return otherDevice(path, "is no camera (" + opened->card + " captures no video)");
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    return problem(path, opened->card + " does not stream (no V4L2_CAP_STREAMING)", false);
  }
  return {std::move(opened), {}, false};
}

}  // namespace edgeslam
