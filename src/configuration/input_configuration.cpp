#include "configuration/input_configuration.h"

#include <algorithm>

#include "configuration/configuration_camera.h"
#include "recording/recording_source.h"

namespace edgeslam {
namespace {

Configuration givenConfiguration(const FrameSource& source, const std::string& file) {
  if (!file.empty()) return readConfiguration(file);
  if (const Recording* recording = source.recording()) return readConfiguration(recording->configuration_path);
  return Configuration();
}

}  // namespace

Configuration configurationFor(const FrameSource& source, const std::string& file) {
  Configuration configuration = givenConfiguration(source, file);
  CameraFindingOptions& finding = configuration.settings.mapping.camera_finding;
  const cv::Size size = source.videoSize();
  const bool is_possible =
      size.width >= 1 && size.height >= 1 && std::max(size.width, size.height) <= largest_camera_side;
  if (configuration.camera || source.camera() || !finding.is_enabled || !is_possible) return configuration;
  configuration.camera = asConfigured(presumedCamera(size.width, size.height), configuration);
  finding.lens_is_presumed = true;
  return configuration;
}

Camera cameraFor(const FrameSource& source, const Configuration& configuration, const std::string& input) {
  if (configuration.camera) return *configuration.camera;
  if (source.camera()) return asConfigured(*source.camera(), configuration);
  throw InputError(input +
                   ": no calibration: put a camera.yaml beside the frames, or give one in the configuration "
                   "(camera.calibration), or "
                   "the camera's size alone (camera.width and camera.height) to have it found on the way");
}

std::string calibrationDoubt(const std::optional<Camera>& beside, const Configuration& configuration) {
  return configuration.camera || !beside ? configuration.camera_doubt : doubtfulDistortion(*beside);
}

}  // namespace edgeslam
