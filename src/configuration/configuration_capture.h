// The configuration's `capture:` section: the live camera and how it is set.
#pragma once

#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "configuration/configuration_camera.h"

namespace edgeslam {

// What of the section's mapping the table of keys has no field for, and checks of the rest. Unknown and repeated keys
// are the caller's business, except inside capture.controls; whether the camera takes the values shows when it is
// opened.
void readCaptureSection(const YAML::Node& section, CameraOptions& options, const TellProblem& tell);

// The section as YAML, only what differs from the defaults; empty where nothing does.
std::string formatCaptureSection(const CameraOptions& options);

}  // namespace edgeslam
