// The configuration's `capture:` section: the live camera and how it is set.
#pragma once

#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "configuration/configuration_camera.h"

namespace edgeslam {

// Names of the keys that the section may hold, each with "capture." before it.
std::vector<std::string> captureKeys();

// Fills the options from the section's mapping. Unknown and repeated keys are the caller's business, except inside
// capture.controls; whether the camera takes the values shows when it is opened.
void readCaptureSection(const YAML::Node& section, CameraOptions& options, const TellProblem& tell);

// The section as YAML, only what differs from the defaults; empty where nothing does.
std::string formatCaptureSection(const CameraOptions& options);

// The section's documentation with an example, all commented out.
std::string captureSectionDocumentation();

}  // namespace edgeslam
