// A configuration as YAML, and the two files that document every key.
#pragma once

#include <string>

#include "configuration/configuration.h"

namespace edgeslam {

// The effective configuration: reads back as the same one, but for the section `viewer:`, whose token is nobody else's
// business. Of what is about camera, messages and disk only what differs from the defaults.
std::string formatConfiguration(const Configuration& configuration);

// The same for a recording, which has the mask's image beside it (recording/recording_layout.h).
std::string formatRecordedConfiguration(Configuration configuration);

// firmware_cfg/edgeslam.yaml: the keys that a user has reason to change, each with documentation, unit, range and
// default.
std::string usersConfigurationText();

// firmware_cfg/expert.yaml: the other keys, one line each.
std::string expertConfigurationText();

}  // namespace edgeslam
