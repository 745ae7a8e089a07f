// Stands in for the driver where libcamera was not there when this program was built.
#include "drivers/libcamera/libcamera_camera.h"

namespace edgeslam {
namespace {

constexpr const char* left_out =
    "this program was built without libcamera (Debian: install libcamera-dev and build again)";

}  // namespace

LibcameraListing listLibcameras() { return {{}, "", left_out}; }

OpenedCamera openLibcameraCamera(const CameraOptions& options) {
  return {nullptr, options.device + ": " + left_out, false};
}

}  // namespace edgeslam
