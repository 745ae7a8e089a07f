#include "drivers/cameras/open_camera.h"

#include <filesystem>

#include "drivers/libcamera/libcamera_camera.h"
#include "drivers/replay/replay_camera.h"
#include "drivers/v4l2/v4l2_camera.h"
#include "frames/frame_source.h"
#include "recording/open_frame_source.h"

namespace edgeslam {
namespace {

OpenedCamera openRecording(const CameraOptions& options) {
  const CaptureClock clock = systemClock();
  try {
    return openReplayCamera(openFrameSource(options.device), options.device, {options.width, options.height},
                            {true, clock.now_ns, clock.sleep_ns});
  } catch (const InputError& error) {
    return {nullptr, error.what(), false};
  }
}

}  // namespace

OpenedCamera openCamera(const CameraOptions& options) {
  if (options.device.empty()) {
    return {nullptr, "no camera is named; `edgeslam cameras` lists them (configuration: capture.device)", false};
  }
  if (options.device.rfind(libcamera_prefix, 0) == 0) return openLibcameraCamera(options);
  std::error_code error;
  const auto status = std::filesystem::status(options.device, error);
  const bool is_recording = std::filesystem::is_directory(status) || std::filesystem::is_regular_file(status);
  return is_recording ? openRecording(options) : openV4l2Camera(options);
}

std::unique_ptr<ReopeningCamera> openLastingCamera(const CameraOptions& options) {
  OpenedCamera opened = openCamera(options);
  if (!opened.camera) throw InputError(opened.problem);
  return std::make_unique<ReopeningCamera>([options] { return openCamera(options); }, std::move(opened.camera));
}

std::unique_ptr<ReopeningCamera> openOrAwaitCamera(const CameraOptions& options, cv::Size size, std::string& problem) {
  OpenedCamera opened = openCamera(options);
  const CameraOpener open = [options] { return openCamera(options); };
  problem = opened.problem;
  if (opened.camera) {
    const StreamDescription& stream = opened.camera->stream();
    if (stream.width != size.width || stream.height != size.height) {
      throw InputError(stream.camera + ": gives " + stream.format + ", the calibration is for " +
                       std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels");
    }
    return std::make_unique<ReopeningCamera>(open, std::move(opened.camera));
  }
  if (!opened.may_heal) throw InputError(opened.problem);
  StreamDescription expected;
  expected.camera = options.device;
  expected.width = size.width;
  expected.height = size.height;
  return std::make_unique<ReopeningCamera>(open, expected, opened.problem);
}

}  // namespace edgeslam
