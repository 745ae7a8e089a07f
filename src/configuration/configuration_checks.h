// What a section of the configuration must fulfil as a whole, beside what is asked of each key.
#pragma once

#include <string>

#include "configuration/configuration.h"

namespace edgeslam {

// What is wrong with the sections `camera`, `lcm`, `scale` or `viewer` and others, naming the key; empty
// for those without a check and where nothing is.
std::string sectionProblem(const std::string& section, const Configuration& configuration);

}  // namespace edgeslam
