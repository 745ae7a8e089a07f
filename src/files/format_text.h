// Numbers in texts.
#pragma once

#include <string>

namespace edgeslam {

// As printf, whole however long it is.
__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...);

}  // namespace edgeslam
