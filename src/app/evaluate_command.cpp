#include "app/evaluate_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "files/atomic_file.h"
#include "files/format_text.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

constexpr double degrees_per_radian = 180.0 / 3.14159265358979323846;

std::map<std::string, Alignment> alignmentNames() {
  return {{"similarity", Alignment::similarity}, {"rigid", Alignment::rigid}, {"none", Alignment::none}};
}

std::string alignmentName(Alignment alignment) {
  for (const auto& [name, value] : alignmentNames()) {
    if (value == alignment) return name;
  }
  return "";
}

std::string fixed(double value, int decimals) { return formatted("%.*f", decimals, value); }

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string row(const std::string& name, const std::string& unit, int pairs, const ErrorStatistics& values,
                double factor, int decimals) {
  std::string line = name + std::string(name.size() < 30 ? 30 - name.size() : 1, ' ') + padded(unit, 4) +
                     padded(std::to_string(pairs), 8);
  for (const double value :
       {values.rmse, values.mean, values.median, values.standard_deviation, values.min, values.max}) {
    line += padded(pairs > 0 ? fixed(factor * value, decimals) : "-", 11);
  }
  return line + "\n";
}

nlohmann::ordered_json toJson(const ErrorStatistics& values, double factor = 1) {
  return {{"rmse", factor * values.rmse},     {"mean", factor * values.mean},
          {"median", factor * values.median}, {"std", factor * values.standard_deviation},
          {"min", factor * values.min},       {"max", factor * values.max}};
}

// "trajectory_map1.txt" and on, beside "trajectory.txt": what a run leaves of maps that were not joined.
struct OtherWorlds {
  int count = 0;
  Trajectory poses;  // of all, by time
};

OtherWorlds otherWorldsOf(const std::string& estimate_path) {
  namespace fs = std::filesystem;
  const fs::path path(estimate_path);
  OtherWorlds others;
  for (int number = 1;; ++number) {
    const std::string name = path.stem().string() + "_map" + std::to_string(number) + path.extension().string();
    std::error_code error;
    if (!fs::is_regular_file(path.parent_path() / name, error)) break;
    ++others.count;
    const std::string file = (path.parent_path() / name).string();
    if (readTextLines(file).empty()) continue;  // no pose was given out in it at the time
    const Trajectory poses = readTrajectory(file);
    others.poses.insert(others.poses.end(), poses.begin(), poses.end());
  }
  return others;
}

// The share of the reference's poses that have one in any map.
double poseShareInAnyWorld(const Trajectory& estimate, const OtherWorlds& others, const Trajectory& reference,
                           double tolerance_s) {
  Trajectory all = estimate;
  all.insert(all.end(), others.poses.begin(), others.poses.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time_ns < b.time_ns; });
  return coverage(all, reference, tolerance_s).pose_share;
}

}  // namespace

int runEvaluate(const EvaluateArguments& arguments) {
  const Trajectory estimate = readTrajectory(arguments.estimate_path);
  const Trajectory reference = readTrajectory(arguments.reference_path);
  const AbsoluteError absolute = absoluteError(estimate, reference, arguments.alignment, arguments.tolerance_s);
  const RelativeError relative =
      relativeError(estimate, reference, arguments.alignment, arguments.delta_s, arguments.tolerance_s);
  const Coverage covered = coverage(estimate, reference, arguments.tolerance_s);
  const OtherWorlds others = otherWorldsOf(arguments.estimate_path);
  const double in_any_world = poseShareInAnyWorld(estimate, others, reference, arguments.tolerance_s);

  if (!arguments.json_path.empty()) {
    nlohmann::ordered_json json;
    json["estimate"] = arguments.estimate_path;
    json["reference"] = arguments.reference_path;
    json["alignment"] = alignmentName(arguments.alignment);
    json["tolerance_s"] = arguments.tolerance_s;
    json["scale"] = absolute.reference_T_estimate.scale;
    json["absolute_error"] = {{"pairs", absolute.pairs}, {"translation_m", toJson(absolute.translation)}};
    json["relative_error"] = {{"delta_s", arguments.delta_s},
                              {"pairs", relative.pairs},
                              {"translation_m", toJson(relative.translation)},
                              {"rotation_deg", toJson(relative.rotation, degrees_per_radian)}};
    json["coverage"] = {{"estimated_poses", estimate.size()},
                        {"reference_poses", reference.size()},
                        {"time_share", covered.time_share},
                        {"pose_share", covered.pose_share},
                        {"pose_share_after_start", covered.pose_share_after_start},
                        {"start_s", covered.start_s},
                        {"maps", 1 + others.count},
                        {"pose_share_in_any_map", in_any_world}};
    writeFileAtomically(arguments.json_path,
                        json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  }

  const std::string interval = fixed(arguments.delta_s, 3) + " s";
  std::string heading(42, ' ');
  heading.replace(0, 5, "error").replace(30, 4, "unit").replace(37, 5, "pairs");
  for (const char* name : {"rmse", "mean", "median", "std", "min", "max"}) heading += padded(name, 11);
  std::cout << "alignment " << alignmentName(arguments.alignment) << ", scale "
            << fixed(absolute.reference_T_estimate.scale, 6) << ", time stamps within "
            << fixed(1000 * arguments.tolerance_s, 1) << " ms\n"
            << heading << "\n"
            << row("absolute, position", "m", absolute.pairs, absolute.translation, 1, 5)
            << row("relative, position / " + interval, "m", relative.pairs, relative.translation, 1, 5)
            << row("relative, rotation / " + interval, "deg", relative.pairs, relative.rotation, degrees_per_radian, 4)
            << "coverage " << fixed(100 * covered.time_share, 1) << " % of the reference's time, "
            << fixed(100 * covered.pose_share, 1) << " % of its " << reference.size() << " poses ("
            << fixed(100 * covered.pose_share_after_start, 1) << " % from the first estimated pose on, which comes at "
            << fixed(covered.start_s, 3) << " s)\n";
  if (others.count > 0) {
    std::cout << "beside it " << others.count << " of maps that were not joined: " << fixed(100 * in_any_world, 1)
              << " % of the reference's poses have one in any map\n";
  }
  return 0;
}

void addEvaluateCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("evaluate", "Error of a trajectory against a reference");
  const auto arguments = std::make_shared<EvaluateArguments>();
  command->add_option("ESTIMATE", arguments->estimate_path, "Trajectory, TUM format (time tx ty tz qx qy qz qw)")
      ->required();
  command->add_option("GROUNDTRUTH", arguments->reference_path, "Reference, TUM format or EuRoC's data.csv")
      ->required();
  const auto alignment = std::make_shared<std::string>(alignmentName(arguments->alignment));
  command->add_option("--alignment", *alignment, "How the estimate is aligned first: similarity, rigid or none")
      ->check(CLI::IsMember({"similarity", "rigid", "none"}).description(""))
      ->capture_default_str();
  command->add_option("--tolerance", arguments->tolerance_s, "Largest difference of associated time stamps [s]")
      ->capture_default_str();
  command->add_option("--delta", arguments->delta_s, "Interval of the relative error [s]")->capture_default_str();
  command->add_option("--json", arguments->json_path, "Write the figures to this file, too")->type_name("FILE");
  command->callback([arguments, alignment, &exit_code] {
    arguments->alignment = alignmentNames().at(*alignment);
    exit_code = runEvaluate(*arguments);
  });
}

}  // namespace edgeslam
