// `edgeslam benchmark`: all sequences under a folder, several at once, into one page.
#pragma once

#include <CLI/CLI.hpp>

namespace edgeslam {

// Adds the subcommand; running it sets `exit_code` (0 all runs have poses, 1 some failed or were not run, 2 by way of
// InputError).
void addBenchmarkCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
