// What the program says of errors that end it.
#pragma once

#include <exception>
#include <string>

namespace edgeslam {

// "out of memory" where that was it; an InputError's message; otherwise "internal error" with what it says of itself.
std::string failureMessage(const std::exception& error);

// From now on an error that no one catches, in whichever thread, ends the program with "edgeslam: MESSAGE" and exit
// code 1 rather than with an abort. Files that are being written stay as they would in a power cut.
void tellUncaughtErrors();

}  // namespace edgeslam
