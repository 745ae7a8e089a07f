// `edgeslam evaluate`: the error of a trajectory against a reference.
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "evaluation/evaluation.h"

namespace edgeslam {

struct EvaluateArguments {
  std::string estimate_path;   // TUM or EuRoC trajectory
  std::string reference_path;  // likewise
  Alignment alignment = Alignment::similarity;
  double tolerance_s = 0.02;  // largest difference of associated time stamps
  double delta_s = 1.0;       // interval of the relative error
  std::string json_path;      // empty: no file
};

// Prints the table of errors to the standard output, writes the JSON file if one is named, and returns the exit code,
// 0. Throws InputError for files that cannot be read or written, and trajectories that have too little in common.
int runEvaluate(const EvaluateArguments& arguments);

// Registers the subcommand; it sets `exit_code` when it was called. Both must outlive the parsing.
void addEvaluateCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
