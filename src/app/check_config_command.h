// `edgeslam check-config`: says what a configuration changes, or everything that is wrong with it.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

// Adds the subcommand; `exit_code` and `app` must outlive the parsing.
void addCheckConfigCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
