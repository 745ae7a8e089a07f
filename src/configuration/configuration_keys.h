// The one table of everything that can be configured: reading, checking, firmware_cfg/edgeslam.yaml and expert.yaml,
// and the listing of an effective configuration all follow from it. A new key is one line in configuration_keys.cpp.
#pragma once

#include <vector>

#include "configuration/configuration.h"
#include "configuration/configuration_value.h"

namespace edgeslam {

// A heading before the keys of each section, in the order of the files; each key points into `configuration`, which
// must outlive them. Keys without a field are read by their section's reader (configuration_camera.h,
// configuration_capture.h).
std::vector<ConfigurationKey> configurationKeys(Configuration& configuration);

// True for the sections of the method, whose every key has a value that can be written.
bool isOfMethod(const ConfigurationKey& key);

}  // namespace edgeslam
