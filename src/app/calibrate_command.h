// `edgeslam calibrate`: a camera's calibration from views of a printed board, and the board to print; a readout, and
// how an inertial unit sits, from a recording.
#pragma once

namespace CLI {
class App;
}

namespace edgeslam {

// Adds the subcommand; `exit_code` and `app` must outlive the parsing.
void addCalibrateCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
