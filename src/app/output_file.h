// The file that a command writes by its --output.
#pragma once

#include <string>

namespace edgeslam {

// Throws InputError where `path` is there already, unless `force`.
void refuseToReplace(const std::string& path, bool force);

}  // namespace edgeslam
