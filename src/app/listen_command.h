// `edgeslam listen`: what is published over LCM, as text.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace edgeslam {

struct ListenArguments {
  std::string url;                    // empty: the environment's LCM_DEFAULT_URL, or LCM's default
  std::vector<std::string> channels;  // names or patterns; empty: SLAM_.*
  std::int64_t count = 0;             // messages to print before it ends; 0: until it is interrupted
};

// Prints a line for each message, for each gap in the numbers, and for the rates of each second. Returns the exit code
// 0. Throws InputError for a URL that cannot be used or opened.
int runListen(const ListenArguments& arguments);

// Registers the subcommand; it sets `exit_code` when it was called. Both must outlive the parsing.
void addListenCommand(CLI::App& app, int& exit_code);

}  // namespace edgeslam
