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

  // Frames `first` to `last` that are in this state.
  int count(const std::string& state, int first, int last) const {
    return static_cast<int>(std::count(states.begin() + first, states.begin() + last + 1, state));
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
  while (std::getline(table, line)) {  // index,time,state,...
    const std::size_t begin = line.find(',', line.find(',') + 1) + 1;
    run.states.push_back(line.substr(begin, line.find(',', begin) - begin));
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
