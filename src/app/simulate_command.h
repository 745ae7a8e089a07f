// `edgeslam simulate`: writes a simulated sequence as a folder in TUM layout.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

// Adds the subcommand; `exit_code` and `app` must outlive the parsing.
void addSimulateCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
