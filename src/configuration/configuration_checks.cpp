#include "configuration/configuration_checks.h"

namespace edgeslam {
namespace {

// A URL or channel that LCM would not take.
std::string lcmProblem(const LcmOptions& options) {
  try {
    checkChannels(options);
    effectiveUrl(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A sensor's channel among the others.
std::string channelProblem(const ServiceOptions& options, std::string LcmOptions::*member, const std::string& channel,
                           const char* key) {
  LcmOptions lcm = options.lcm;
  if (!lcmProblem(lcm).empty()) return "";  // told of the section `lcm:`
  lcm.*member = channel;
  const std::string wrong = lcmProblem(lcm);
  return wrong.empty() ? "" : std::string(key) + ": " + wrong;
}

// A source that lacks what it needs.
std::string scaleProblem(const ScaleOptions& scale) {
  if (scale.source != "none" && scale.source != "camera_height" && scale.source != "odometry") {
    return "scale.source: '" + scale.source + "' is no source; expected none, camera_height or odometry";
  }
  if (scale.source == "camera_height" && scale.height.camera_height_m <= 0) {
    return "scale.source: camera_height needs scale.camera_height_m";
  }
  const bool needs_channel = scale.source == "odometry" && scale.odometry.channel.empty();
  return needs_channel ? "scale.source: odometry needs scale.odometry_channel" : "";
}

// A lens that is presumed, and never looked for.
std::string lensProblem(const CameraFindingOptions& finding) {
  if (!finding.lens_is_presumed || finding.is_enabled) return "";
  return "camera_finding.enabled: expected true: of the camera only its size is given, and without this its lens stays "
         "as it is presumed";
}

}  // namespace

std::string sectionProblem(const std::string& section, const Configuration& configuration) {
  const ServiceOptions& service = configuration.service;
  if (section == "viewer") return viewerProblem(service.viewer);
  if (section == "camera" || section == "camera_finding") {
    return lensProblem(configuration.settings.mapping.camera_finding);
  }
  if (section == "ros2") return ros2Problem(service.ros2);
  if (section == "imu") {
    return channelProblem(service, &LcmOptions::imu_channel, configuration.inertia.channel, "imu.channel");
  }
  if (section == "lcm") {
    if (const std::string wrong = lcmProblem(service.lcm); !wrong.empty()) return "lcm: " + wrong;
  }
  // The wheels' channel may be in a section before this one, or in an included file.
  const bool are_heard = service.scale.source == "odometry" || configuration.settings.wheels.enabled;
  if (section == "scale" || (section == "lcm" && service.scale.source == "odometry")) {
    if (std::string wrong = scaleProblem(service.scale); !wrong.empty()) return wrong;
  }
  const bool is_theirs = section == "scale" || section == "lcm" || section == "wheels";
  if (!is_theirs || !are_heard) return "";
  return channelProblem(service, &LcmOptions::wheels_channel, service.scale.odometry.channel, "scale.odometry_channel");
}

}  // namespace edgeslam
