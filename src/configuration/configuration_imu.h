// The configuration's `imu:` section: the inertial unit that is fixed to the camera, inline or in a file of its own.
#pragma once

#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "configuration/configuration_camera.h"

namespace edgeslam {

// What of the section's mapping the table of keys has no field for: where the unit sits, and a file with all of it,
// whose path is relative to the configuration file. Unknown and repeated keys are the caller's business.
void readImuSection(const YAML::Node& section, Configuration& configuration, const TellProblem& tell);

// The section as YAML; empty where no unit is given and none is used.
std::string formatImuSection(const InertiaConfiguration& inertia);

}  // namespace edgeslam
