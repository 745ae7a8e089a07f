// The page of a set of runs: the paper's table with ours, accuracy, speed, loops and states, each figure leading to its
// run's report.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/run_figures.h"

namespace edgeslam {

struct SetRun {
  std::string name;
  std::string input;                  // path of the sequence; its name finds the published figures
  std::string link;                   // address of its report.html, relative to the page; empty where there is none
  std::optional<RunFigures> figures;  // none where the run left none
  bool failed = false;
  std::string message;  // why it failed
  std::optional<double> cpu_s, peak_mib;
};

struct RunSet {
  std::string title, note;
  std::vector<SetRun> runs;
  int jobs = 1;  // runs that went on at once
};

// The address of `path` in a page that lies in `page_folder`, such that both can be moved together.
std::string relativeLink(const std::string& page_folder, const std::string& path);

nlohmann::ordered_json setData(const RunSet& set);
std::string formatSetPage(const RunSet& set);

// The same for a terminal: a line a run.
std::string formatSetTable(const RunSet& set);

}  // namespace edgeslam
