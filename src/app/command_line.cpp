#include "app/command_line.h"

#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "app/benchmark_command.h"
#include "app/calibrate_command.h"
#include "app/cameras_command.h"
#include "app/check_config_command.h"
#include "app/evaluate_command.h"
#include "app/listen_command.h"
#include "app/map_command.h"
#include "app/mask_command.h"
#include "app/record_command.h"
#include "app/replay_command.h"
#include "app/report_command.h"
#include "app/run_command.h"
#include "app/simulate_command.h"
#include "app/view_command.h"
#include "edgeslam/input_error.h"
#include "service/failure_message.h"

namespace edgeslam {
namespace {

int tellFailure(ExitCode code, const std::string& message) {
  std::cerr << "edgeslam: " << message << std::endl;
  return code;
}

// A reader that went away (`| head`) is no failure; a full disk behind the standard output is.
bool standardOutputLost() {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return false;
  struct stat status {};
  return fstat(STDOUT_FILENO, &status) != 0 || !(S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode));
}

int parseAndRun(int argc, const char* const* argv) {
  int exit_code = exit_done;
  CLI::App app{"Monocular SLAM on image edges: poses and a 3D map from one camera.", "edgeslam"};
  app.set_version_flag("--version", std::string("edgeslam ") + EDGESLAM_VERSION);
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 the run failed, 2 wrong use or bad input.");
  addRunCommand(app, exit_code);
  addReplayCommand(app, exit_code);
  addViewCommand(app, exit_code);
  addEvaluateCommand(app, exit_code);
  addReportCommand(app, exit_code);
  addBenchmarkCommand(app, exit_code);
  addSimulateCommand(app, exit_code);
  addListenCommand(app, exit_code);
  addCalibrateCommand(app, exit_code);
  addMapCommand(app, exit_code);
  addMaskCommand(app, exit_code);
  addCheckConfigCommand(app, exit_code);
  addCamerasCommand(app, exit_code);
  addRecordCommand(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    app.exit(request);
  } catch (const CLI::ParseError& error) {
    const CLI::App* named = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
    const std::string help = named == &app ? "edgeslam --help" : "edgeslam " + named->get_name() + " --help";
    return tellFailure(exit_bad_input, std::string(error.what()) + "; see " + help);
  }
  return exit_code;
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
  int exit_code = exit_failed;
  try {
    exit_code = parseAndRun(argc, argv);
  } catch (const InputError& error) {
    exit_code = tellFailure(exit_bad_input, error.what());
  } catch (const std::exception& error) {  // cv::Exception among them
    exit_code = tellFailure(exit_failed, failureMessage(error));
  }
  if (standardOutputLost()) {
    return tellFailure(exit_bad_input, "the standard output cannot be written (is the disk full?)");
  }
  return exit_code;
}

}  // namespace edgeslam
