// The `edgeslam` command: its subcommands, and what its exit code says (design, section 6).
#pragma once

namespace edgeslam {

enum ExitCode : int {
  exit_done = 0,
  exit_failed = 1,    // the run failed its own checks, or the program itself failed
  exit_bad_input = 2  // wrong use, or input that cannot be used
};

// Runs the subcommand that the arguments name and returns the exit code. Never throws: every failure becomes one line
// on the standard error, `edgeslam: MESSAGE`.
int runCommandLine(int argc, const char* const* argv);

}  // namespace edgeslam
