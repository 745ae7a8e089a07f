// What changed between the figures of two runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/run_figures.h"

namespace edgeslam {

enum class Verdict {
  better,
  worse,
  same,       // within what the figure scatters: 1 %, times 10 %
  different,  // neither is better by itself: the number of keyframes
  unknown     // one of the runs does not have it
};

const char* verdictName(Verdict verdict);

struct FigureChange {
  std::string name, unit;
  std::optional<double> first, second;
  Verdict verdict = Verdict::unknown;
};

// The headline figures, in the order of a report: errors [cm], coverage [%], times to the first pose [s], numbers of
// keyframes, points, recoveries, relocalisations and loops, frames lost, times [ms], speed.
std::vector<FigureChange> figureChanges(const RunFigures& first, const RunFigures& second);

// A setting whose value differs; "-" where one of the configurations does not have the line.
struct SettingChange {
  std::string key;  // "edges.sigma"
  std::string first, second;
};

// Compares two configurations as formatConfiguration writes them, line by line; what is in both the same is left out.
std::vector<SettingChange> settingChanges(const std::string& first, const std::string& second);

}  // namespace edgeslam
