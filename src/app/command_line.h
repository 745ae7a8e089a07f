// The `edgeslam` command: its subcommands, and what its exit code says (design, section 6).
#pragma once

#include "service/exit_code.h"

namespace edgeslam {

// Runs the subcommand that the arguments name and returns the exit code. Never throws: every failure becomes one line
// on the standard error, `edgeslam: MESSAGE`.
int runCommandLine(int argc, const char* const* argv);

}  // namespace edgeslam
