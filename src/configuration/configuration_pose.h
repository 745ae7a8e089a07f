// A pose in the configuration: a 4x4 matrix row by row, or a translation and a quaternion.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "geometry/pose.h"

namespace edgeslam {

// Fills `pose`; otherwise leaves it as it was and says what is wrong with the value.
std::string readPose(const YAML::Node& node, Pose& pose);

// As YAML, in a line, to the last bit.
std::string formatPose(const Pose& pose);

}  // namespace edgeslam
