// `edgeslam run`: the service on the robot.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

// Adds the subcommand; `exit_code` and `app` must outlive the parsing.
void addRunCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
