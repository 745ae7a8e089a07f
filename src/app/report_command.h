// `edgeslam report`: two finished runs side by side, or the page of a set of them.
#pragma once

#include <CLI/CLI.hpp>

namespace edgeslam {

// Adds the subcommand; running it sets `exit_code`.
void addReportCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
