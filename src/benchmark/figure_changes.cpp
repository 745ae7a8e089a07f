#include "benchmark/figure_changes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace edgeslam {
namespace {

enum class Wish { less, more, none };

constexpr double scatter = 0.01, scatter_of_times = 0.1;  // shares that say nothing

class Changes {
 public:
  void add(const std::string& name, const std::string& unit, std::optional<double> first, std::optional<double> second,
           Wish wish, double tolerance = scatter) {
    FigureChange change{name, unit, first, second, Verdict::unknown};
    if (first && second) change.verdict = verdictOf(*first, *second, wish, tolerance);
    changes_.push_back(change);
  }
  std::vector<FigureChange> take() { return std::move(changes_); }

 private:
  static Verdict verdictOf(double first, double second, Wish wish, double tolerance) {
    if (std::abs(second - first) <= tolerance * std::max(std::abs(first), std::abs(second))) return Verdict::same;
    if (wish == Wish::none) return Verdict::different;
    return (second < first) == (wish == Wish::less) ? Verdict::better : Verdict::worse;
  }
  std::vector<FigureChange> changes_;
};

std::optional<double> centimetres(const std::optional<ErrorFigures>& error) {
  return error ? std::optional<double>(100 * error->rmse_m) : std::nullopt;
}

std::optional<double> framesIn(const RunFigures& run, const std::string& state) {
  const auto found = run.states.find(state);
  if (found == run.states.end()) return std::nullopt;
  return static_cast<double>(found->second);
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// "section.key" and the value of every line; of a key that is repeated the first.
std::vector<std::pair<std::string, std::string>> settingsOf(const std::string& configuration) {
  std::vector<std::pair<std::string, std::string>> settings;
  std::set<std::string> seen;
  std::istringstream lines(configuration);
  std::string line, section;
  while (std::getline(lines, line)) {
    const std::string text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string key = text.substr(0, colon);
    const std::string value = colon < text.size() ? trimmed(text.substr(colon + 1)) : "";
    const bool is_indented = line.front() == ' ' || line.front() == '\t';
    if (!is_indented) section = key;
    if (!is_indented && value.empty()) continue;
    const std::string name = is_indented && !section.empty() ? std::string(section).append(".").append(key) : key;
    if (seen.insert(name).second) settings.emplace_back(name, value);
  }
  return settings;
}

}  // namespace

const char* verdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::better:
      return "better";
    case Verdict::worse:
      return "worse";
    case Verdict::same:
      return "same";
    case Verdict::different:
      return "different";
    case Verdict::unknown:
      break;
  }
  return "unknown";
}

std::vector<FigureChange> figureChanges(const RunFigures& first, const RunFigures& second) {
  Changes changes;
  const auto count = [&](const std::string& name, std::int64_t RunFigures::*figure, Wish wish) {
    changes.add(name, "", static_cast<double>(first.*figure), static_cast<double>(second.*figure), wish, 0);
  };
  changes.add("Trajectory error", "cm", centimetres(first.trajectory), centimetres(second.trajectory), Wish::less);
  changes.add("Error of the live poses", "cm", centimetres(first.live), centimetres(second.live), Wish::less);
  changes.add("Error of the keyframes", "cm", centimetres(first.at_keyframes), centimetres(second.at_keyframes),
              Wish::less);
  changes.add("Frames with a pose, from the first on", "%", 100 * first.coverage, 100 * second.coverage, Wish::more,
              0.001);
  changes.add("Frames with a pose, of all", "%", 100 * posedShare(first), 100 * posedShare(second), Wish::more, 0.001);
  changes.add("Frames with a pose in any map, of all", "%", 100 * posedShareInAnyWorld(first),
              100 * posedShareInAnyWorld(second), Wish::more, 0.001);
  count("Maps that were not joined", &RunFigures::worlds, Wish::less);
  changes.add("First pose after", "s", first.first_pose_s, second.first_pose_s, Wish::less);
  changes.add("First live pose after", "s", first.first_live_pose_s, second.first_live_pose_s, Wish::less);
  changes.add("Frames lost", "", framesIn(first, "lost"), framesIn(second, "lost"), Wish::less, 0);
  changes.add("Frames with a predicted pose only", "", framesIn(first, "predicted"), framesIn(second, "predicted"),
              Wish::less, 0);
  count("Frames dropped", &RunFigures::dropped, Wish::less);
  count("Keyframes", &RunFigures::keyframes, Wish::none);
  count("Map points", &RunFigures::map_points, Wish::none);
  count("Recoveries", &RunFigures::recoveries, Wish::none);
  count("Relocalisations", &RunFigures::relocalisations, Wish::none);
  changes.add("Loops closed", "", static_cast<double>(first.loops.size()), static_cast<double>(second.loops.size()),
              Wish::none, 0);
  const StageFigures *a = stageOf(first, "tracking"), *b = stageOf(second, "tracking");
  const auto time = [](const StageFigures* stage, double StageFigures::*figure) {
    return stage ? std::optional<double>(stage->*figure) : std::nullopt;
  };
  changes.add("Tracking a frame, median", "ms", time(a, &StageFigures::median), time(b, &StageFigures::median),
              Wish::less, scatter_of_times);
  changes.add("Tracking a frame, 99 %", "ms", time(a, &StageFigures::percentile_99),
              time(b, &StageFigures::percentile_99), Wish::less, scatter_of_times);
  changes.add("Times real time", "", first.real_time_ratio, second.real_time_ratio, Wish::more, scatter_of_times);
  return changes.take();
}

std::vector<SettingChange> settingChanges(const std::string& first, const std::string& second) {
  const auto a = settingsOf(first), b = settingsOf(second);
  const std::map<std::string, std::string> in_a(a.begin(), a.end()), in_b(b.begin(), b.end());
  std::vector<SettingChange> changes;
  for (const auto& [key, value] : a) {
    const auto other = in_b.find(key);
    const std::string theirs = other == in_b.end() ? "-" : other->second;
    if (theirs != value) changes.push_back({key, value, theirs});
  }
  for (const auto& [key, value] : b) {
    if (in_a.count(key) == 0) changes.push_back({key, "-", value});
  }
  return changes;
}

}  // namespace edgeslam
