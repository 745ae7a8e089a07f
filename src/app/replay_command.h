// `edgeslam replay`: the main job. Frames from a folder or video go in; trajectory, map, error figures and a report
// come out.
#pragma once

#include <CLI/CLI.hpp>

namespace edgeslam {

// Adds the subcommand; running it sets `exit_code` (0 done, 1 no map came to stand, 2 by way of InputError).
void addReplayCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
