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

// A source that lacks what it needs.
std::string scaleProblem(const ServiceOptions& options) {
  const ScaleOptions& scale = options.scale;
  if (scale.source != "none" && scale.source != "camera_height" && scale.source != "odometry") {
    return "scale.source: '" + scale.source + "' is no source; expected none, camera_height or odometry";
  }
  if (scale.source == "camera_height" && scale.height.camera_height_m <= 0) {
    return "scale.source: camera_height needs scale.camera_height_m";
  }
  if (scale.source != "odometry") return "";
  if (scale.odometry.channel.empty()) return "scale.source: odometry needs scale.odometry_channel";
  LcmOptions lcm = options.lcm;
  if (!lcmProblem(lcm).empty()) return "";  // told of the section `lcm:`
  lcm.wheels_channel = scale.odometry.channel;
  const std::string wrong = lcmProblem(lcm);
  return wrong.empty() ? "" : "scale.odometry_channel: " + wrong;
}

// The unit's channel among the others.
std::string imuProblem(const Configuration& configuration) {
  LcmOptions lcm = configuration.service.lcm;
  if (!lcmProblem(lcm).empty()) return "";  // told of the section `lcm:`
  lcm.imu_channel = configuration.inertia.channel;
  const std::string wrong = lcmProblem(lcm);
  return wrong.empty() ? "" : "imu.channel: " + wrong;
}

}  // namespace

std::string sectionProblem(const std::string& section, const Configuration& configuration) {
  const ServiceOptions& service = configuration.service;
  if (section == "viewer") return viewerProblem(service.viewer);
  if (section == "ros2") return ros2Problem(service.ros2);
  if (section == "imu") return imuProblem(configuration);
  if (section == "lcm") {
    if (const std::string wrong = lcmProblem(service.lcm); !wrong.empty()) return "lcm: " + wrong;
  }
  // The wheels' channel may be in a section before this one, or in an included file.
  const bool is_for_scale = section == "lcm" && service.scale.source == "odometry";
  return section == "scale" || is_for_scale ? scaleProblem(service) : "";
}

}  // namespace edgeslam
