// What a run of the program left, for tests to look at.
#pragma once

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "evaluation/evaluation.h"
#include "evaluation/trajectory.h"
#include "system/program.h"

namespace edgeslam {

struct ReplayedRun {
  Outcome outcome;
  std::string folder;
  nlohmann::json summary;
  std::vector<std::string> states;  // of each frame
  std::vector<int> worlds;          // of each frame's pose as it was given out; -1: none

  // Frames `first` to `last` that are in this state.
  int count(const std::string& state, int first, int last) const {
    return static_cast<int>(std::count(states.begin() + first, states.begin() + last + 1, state));
  }
  // Those among them whose pose was measured.
  int countGood(int first, int last) const {
    return count("tracking", first, last) + count("recovered", first, last) + count("relocalised", first, last);
  }
  // The first frame from `first` on whose pose was measured, or -1.
  int firstGood(int first) const {
    for (int i = first; i < static_cast<int>(states.size()); ++i) {
      const std::string& state = states[static_cast<std::size_t>(i)];
      if (state == "tracking" || state == "recovered" || state == "relocalised") return i;
    }
    return -1;
  }
};

// Of a line of a table; a quoted cell may hold commas.
inline std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '"') {
      cells.back() += c;
    }
  }
  return cells;
}

inline ReplayedRun replayed(const std::string& sequence, const std::string& result,
                            const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"replay", sequence, "--output", result, "--drawings", "0"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  ReplayedRun run;
  run.outcome = runProgram(arguments);
  run.folder = result;
  const std::string summary = fileContent(result + "/summary.json");
  if (summary.empty()) return run;
  run.summary = nlohmann::json::parse(summary);
  std::istringstream table(fileContent(result + "/frames.csv"));
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> names = cellsOf(line);
  const auto world = std::find(names.begin(), names.end(), "live_world") - names.begin();
  while (std::getline(table, line)) {  // index,time,state,...
    const std::vector<std::string> cells = cellsOf(line);
    run.states.push_back(cells.at(2));
    const std::string& told = cells.at(static_cast<std::size_t>(world));
    run.worlds.push_back(told.empty() ? -1 : std::stoi(told));
  }
  return run;
}

// The largest error of any pose [m] after one similarity alignment of all.
inline double largestError(const Trajectory& estimate, const Trajectory& truth) {
  return absoluteError(estimate, truth, Alignment::similarity, 0.001).translation.max;
}

inline Trajectory joined(Trajectory a, const Trajectory& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end(), [](const auto& one, const auto& other) { return one.time_ns < other.time_ns; });
  return a;
}

}  // namespace edgeslam
