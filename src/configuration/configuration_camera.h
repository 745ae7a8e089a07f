// The configuration's `camera:` section: a calibration, inline or in a file of its own, and the camera's place on the
// robot.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "configuration/configuration_value.h"

namespace edgeslam {

// Receives a problem and the line (from 0) at which it is.
using TellProblem = std::function<void(int line, const std::string& problem)>;

// True for a document that is a camera's calibration by itself, of any of the kinds that readCalibration knows.
bool isCalibration(const YAML::Node& document);

// The keys of an inline calibration of either camera model, for the table of keys: documented, without fields.
std::vector<ConfigurationKey> calibrationKeyNames();

// A camera of which only the size is known [px]: a run finds how its lens is (mapping/camera_finding.h).
Camera presumedCamera(int width, int height);

// Fills camera, readout_s, mask and body_T_camera from the section's mapping; the paths of a calibration and of a mask
// are relative to the configuration file. Unknown and repeated keys are the caller's business.
void readCameraSection(const YAML::Node& section, Configuration& configuration, const TellProblem& tell);

// The section as YAML; empty where there is neither a camera nor a pose.
std::string formatCameraSection(const Configuration& configuration);

}  // namespace edgeslam
