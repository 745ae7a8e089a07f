#include "benchmark/comparison.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "benchmark/figure_changes.h"
#include "benchmark/optional_json.h"
#include "benchmark/page_assets.h"
#include "evaluation/evaluation.h"
#include "report/display_frame.h"
#include "report/page_template.h"
#include "report/report_assets.h"

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_samples = 4000;  // of a series over time: more than a screen has columns

std::size_t strideFor(std::size_t count) { return std::max<std::size_t>(1, (count + most_samples - 1) / most_samples); }

double rounded(double value, double decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit;
}

// Seconds from the beginning of the page's axis of time.
struct Clock {
  std::int64_t start_ns = 0;
  double operator()(std::int64_t time_ns) const { return rounded(1e-9 * static_cast<double>(time_ns - start_ns), 3); }
};

// Common where the runs are over the same time, otherwise each from its own first frame.
std::pair<Clock, Clock> clocksOf(const ComparedRun& first, const ComparedRun& second) {
  if (first.frames.empty() || second.frames.empty()) {
    return {{first.frames.empty() ? 0 : first.frames.front().time_ns},
            {second.frames.empty() ? 0 : second.frames.front().time_ns}};
  }
  const std::int64_t a = first.frames.front().time_ns, b = second.frames.front().time_ns;
  const bool overlap = a <= second.frames.back().time_ns && b <= first.frames.back().time_ns;
  if (!overlap) return {{a}, {b}};
  return {{std::min(a, b)}, {std::min(a, b)}};
}

Trajectory moved(const Similarity& display_T_world, Trajectory trajectory) {
  for (StampedPose& pose : trajectory) {
    pose.world_T_camera.translation = display_T_world * pose.world_T_camera.translation;
    pose.world_T_camera.rotation = (display_T_world.rotation * pose.world_T_camera.rotation).normalized();
  }
  return trajectory;
}

// Both trajectories as they are drawn.
struct Overlay {
  Trajectory first, second;
  DisplayFrame frame;
  std::string relation;  // "ground truth", "first run", "none"
  std::string unit;
};

std::optional<Similarity> alignmentOf(const ComparedRun& run) {
  return run.figures.trajectory ? run.figures.trajectory->reference_T_world : std::nullopt;
}

// As absoluteError; nothing where too few poses are at the same times.
std::optional<AbsoluteError> errorIfComparable(const Trajectory& estimate, const Trajectory& reference,
                                               Alignment alignment) {
  try {
    return absoluteError(estimate, reference, alignment);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Overlay overlayOf(const ComparedRun& first, const ComparedRun& second) {
  const Trajectory a = finalTrajectory(first.frames), b = finalTrajectory(second.frames);
  const auto reference_T_a = alignmentOf(first), reference_T_b = alignmentOf(second);
  const std::optional<AbsoluteError> between = errorIfComparable(b, a, Alignment::similarity);
  Overlay overlay;
  overlay.frame = displayFrame(a, reference_T_a);
  overlay.first = moved(overlay.frame.display_T_world, a);
  overlay.unit = overlay.frame.aligned ? "m" : "map units";
  if (between && reference_T_a && reference_T_b) {
    Similarity display_T_reference;
    display_T_reference.rotation = overlay.frame.display_R_reference;
    overlay.second = moved(display_T_reference * *reference_T_b, b);
    overlay.relation = "ground truth";
  } else if (between) {
    overlay.second = moved(overlay.frame.display_T_world * between->reference_T_estimate, b);
    overlay.relation = "first run";
  } else {
    overlay.second = moved(displayFrame(b, reference_T_b).display_T_world, b);
    overlay.relation = "none";
  }
  return overlay;
}

ordered_json trajectoryJson(const Trajectory& trajectory, const Clock& clock) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : trajectory) box.extend(pose.world_T_camera.translation);
  const double size = trajectory.empty() ? 1 : std::max(box.diagonal().norm(), 1e-9);
  const double decimals = std::clamp(std::ceil(5 - std::log10(size)), 0.0, 12.0);
  ordered_json times = ordered_json::array(), positions = ordered_json::array();
  for (std::size_t i = 0; i < trajectory.size(); i += strideFor(trajectory.size())) {
    times.push_back(clock(trajectory[i].time_ns));
    for (int k = 0; k < 3; ++k) positions.push_back(rounded(trajectory[i].world_T_camera.translation[k], decimals));
  }
  return {{"times", times}, {"positions", positions}};
}

ordered_json distanceJson(const Overlay& overlay, const Clock& clock) {
  if (overlay.relation == "none") return nullptr;
  const auto error = errorIfComparable(overlay.second, overlay.first, Alignment::none);
  if (!error) return nullptr;
  ordered_json times = ordered_json::array(), distances = ordered_json::array();
  for (std::size_t i = 0; i < error->errors.size(); i += strideFor(error->errors.size())) {
    times.push_back(clock(error->times_ns[i]));
    distances.push_back(rounded(error->errors[i], 6));
  }
  return {{"times", times},
          {"distances", distances},
          {"rmse", error->translation.rmse},
          {"median", error->translation.median},
          {"max", error->translation.max}};
}

// Stretches of frames of the same state, with the reason in which each began.
ordered_json statesJson(const std::vector<FrameRow>& frames, const Clock& clock) {
  ordered_json stretches = ordered_json::array();
  for (std::size_t begin = 0; begin < frames.size();) {
    std::size_t end = begin + 1;
    const bool posed = frames[begin].final_pose.has_value();
    while (end < frames.size() && frames[end].state == frames[begin].state &&
           frames[end].final_pose.has_value() == posed) {
      ++end;
    }
    stretches.push_back({{"from", clock(frames[begin].time_ns)},
                         {"to", clock(frames[std::min(end, frames.size() - 1)].time_ns)},
                         {"state", frames[begin].state},
                         {"reason", frames[begin].reason},
                         {"final_pose", posed},
                         {"frames", end - begin}});
    begin = end;
  }
  return stretches;
}

// Means over what one column of the chart stands for.
ordered_json frameTimesJson(const std::vector<FrameRow>& frames, const Clock& clock) {
  const std::size_t stride = strideFor(2 * frames.size());
  ordered_json times = ordered_json::array(), values = ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); i += stride) {
    const std::size_t end = std::min(i + stride, frames.size());
    double sum = 0;
    for (std::size_t j = i; j < end; ++j) sum += frames[j].time_ms;
    times.push_back(clock(frames[i].time_ns));
    values.push_back(rounded(sum / static_cast<double>(end - i), 2));
  }
  return {{"times", times}, {"values_ms", values}};
}

ordered_json stageJson(const StageFigures* stage) {
  if (!stage) return nullptr;
  return {{"frames", stage->frames},
          {"mean", stage->mean},
          {"p50", stage->median},
          {"p99", stage->percentile_99},
          {"max", stage->max}};
}

// In the order of the first run, then what only the second has.
ordered_json stagesJson(const RunFigures& first, const RunFigures& second) {
  ordered_json stages = ordered_json::array();
  const auto add = [&](const std::string& name) {
    stages.push_back(
        {{"name", name}, {"first", stageJson(stageOf(first, name))}, {"second", stageJson(stageOf(second, name))}});
  };
  for (const StageFigures& stage : first.stages) add(stage.name);
  for (const StageFigures& stage : second.stages) {
    if (!stageOf(first, stage.name)) add(stage.name);
  }
  return stages;
}

ordered_json figuresJson(const RunFigures& first, const RunFigures& second) {
  ordered_json figures = ordered_json::array();
  for (const FigureChange& change : figureChanges(first, second)) {
    figures.push_back({{"name", change.name},
                       {"unit", change.unit},
                       {"first", optionalJson(change.first)},
                       {"second", optionalJson(change.second)},
                       {"verdict", verdictName(change.verdict)}});
  }
  return figures;
}

// What was run, where it differs: input, command, versions.
ordered_json originsJson(const RunFigures& first, const RunFigures& second) {
  ordered_json origins = ordered_json::array();
  const auto add = [&](const std::string& name, const std::string& a, const std::string& b) {
    if (a != b) origins.push_back({{"name", name}, {"first", a}, {"second", b}});
  };
  add("Input", first.input, second.input);
  add("Command", first.command_line, second.command_line);
  add("Initialisation", first.initialisation, second.initialisation);
  add("edgeslam", first.program_version, second.program_version);
  std::map<std::string, std::string> names = first.library_versions;
  names.insert(second.library_versions.begin(), second.library_versions.end());
  const auto versionIn = [](const RunFigures& run, const std::string& name) {
    const auto found = run.library_versions.find(name);
    return found == run.library_versions.end() ? "-" : found->second;
  };
  for (const auto& [name, version] : names) add(name, versionIn(first, name), versionIn(second, name));
  return origins;
}

ordered_json settingsJson(const RunFigures& first, const RunFigures& second) {
  ordered_json settings = ordered_json::array();
  for (const SettingChange& change : settingChanges(first.configuration, second.configuration)) {
    settings.push_back({{"name", change.key}, {"first", change.first}, {"second", change.second}});
  }
  return settings;
}

ordered_json runJson(const ComparedRun& run, const Trajectory& trajectory, const Clock& clock) {
  return {{"folder", run.folder},
          {"sequence", run.figures.sequence},
          {"counts", run.figures.states},
          {"trajectory", trajectoryJson(trajectory, clock)},
          {"states", statesJson(run.frames, clock)},
          {"frame_times", frameTimesJson(run.frames, clock)}};
}

double frameInterval_ms(const std::vector<FrameRow>& frames) {
  if (frames.size() < 2) return 0;
  const auto span = static_cast<double>(frames.back().time_ns - frames.front().time_ns);
  return rounded(1e-6 * span / static_cast<double>(frames.back().index - frames.front().index), 2);
}

}  // namespace

ComparedRun readComparedRun(const std::string& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw InputError(folder + ": expected the folder of a finished run, with summary.json and frames.csv");
  }
  return {folder, readRunFigures(folder), readFrameTable(folder)};
}

ordered_json comparisonData(const ComparedRun& first, const ComparedRun& second) {
  const auto [first_clock, second_clock] = clocksOf(first, second);
  const Overlay overlay = overlayOf(first, second);
  return {{"first", runJson(first, overlay.first, first_clock)},
          {"second", runJson(second, overlay.second, second_clock)},
          {"figures", figuresJson(first.figures, second.figures)},
          {"relation", overlay.relation},
          {"unit", overlay.unit},
          {"axes", {overlay.frame.x_name, overlay.frame.y_name, overlay.frame.z_name}},
          {"distance", distanceJson(overlay, second_clock)},
          {"frame_interval_ms", frameInterval_ms(first.frames)},
          {"stages", stagesJson(first.figures, second.figures)},
          {"settings", settingsJson(first.figures, second.figures)},
          {"origins", originsJson(first.figures, second.figures)}};
}

std::string formatComparison(const ComparedRun& first, const ComparedRun& second) {
  const PageAssets assets = pageAssets();
  const ReportAssets shared = reportAssets();
  const std::string title = escapedForHtml(first.figures.sequence == second.figures.sequence
                                               ? first.figures.sequence
                                               : first.figures.sequence + " and " + second.figures.sequence);
  const std::string data = escapedForScript(comparisonData(first, second));
  return filledIn(assets.comparison_page, {{"title", title},
                                           {"style", shared.style},
                                           {"pages_style", assets.style},
                                           {"data", data},
                                           {"charts", shared.charts},
                                           {"trajectory", shared.trajectory},
                                           {"tables", assets.tables},
                                           {"script", assets.comparison_script}});
}

}  // namespace edgeslam
