// The configuration's sections `lcm:`, `map:`, `recording:`, `scale:` and `viewer:`: what `edgeslam run` gives out and
// keeps.
#pragma once

#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "configuration/configuration_camera.h"

namespace edgeslam {

const std::vector<std::string>& serviceSections();

// Names of the keys that the sections may hold, "lcm.url" and so on.
std::vector<std::string> serviceKeys();

// Fills the configuration from the mapping of one of the sections. Unknown and repeated keys are the caller's business.
void readServiceSection(const std::string& section, const YAML::Node& node, Configuration& configuration,
                        const TellProblem& tell);

// The sections as YAML, only what differs from the defaults; empty where nothing does. Without `viewer:`: recordings
// and results keep this text, and its token is nobody else's business.
std::string formatServiceSections(const Configuration& configuration);

// The sections' documentation with their defaults.
std::string serviceSectionsDocumentation();

}  // namespace edgeslam
