// What the program's exit code says (design, section 6).
#pragma once

namespace edgeslam {

enum ExitCode : int {
  exit_done = 0,
  exit_failed = 1,    // the run failed its own checks, or the program itself failed
  exit_bad_input = 2  // wrong use, or input that cannot be used
};

}  // namespace edgeslam
