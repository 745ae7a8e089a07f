// Numbers in texts.
#pragma once

#include <string>

namespace edgeslam {

// As printf, whole however long it is.
__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...);

// The text without digits and points: of two lines that differ in their numbers alone it is the same.
std::string withoutDigits(std::string text);

}  // namespace edgeslam
