// What a section of the configuration must fulfil as a whole, beside what is asked of each key.
#pragma once

#include <string>

#include "configuration/configuration.h"

namespace edgeslam {

// What is wrong with the sections `lcm`, `scale` or `viewer`, naming the key; empty for others and where nothing is.
std::string sectionProblem(const std::string& section, const Configuration& configuration);

}  // namespace edgeslam
