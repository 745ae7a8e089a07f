#include "benchmark/set_page.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "benchmark/optional_json.h"
#include "benchmark/page_assets.h"
#include "files/format_text.h"
#include "report/page_template.h"
#include "report/report_assets.h"
#include "report/report_published.h"

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

ordered_json errorJson(const std::optional<ErrorFigures>& error) {
  if (!error) return nullptr;
  return {{"pairs", error->pairs}, {"rmse_m", error->rmse_m}, {"median_m", error->median_m}, {"max_m", error->max_m}};
}

ordered_json timesJson(const StageFigures* stage) {
  if (!stage) return nullptr;
  return {{"mean", stage->mean}, {"p50", stage->median}, {"p99", stage->percentile_99}, {"max", stage->max}};
}

ordered_json figuresJson(const RunFigures& run) {
  ordered_json loops = ordered_json::array();
  for (const LoopFigures& loop : run.loops) {
    loops.push_back({{"frame", loop.frame},
                     {"how", loop.how},
                     {"before", errorJson(loop.before)},
                     {"after", errorJson(loop.after)}});
  }
  return {{"frames", run.frames},
          {"with_pose", run.with_pose},
          {"has_ground_truth", run.has_ground_truth},
          {"trajectory", errorJson(run.trajectory)},
          {"live", errorJson(run.live)},
          {"keyframe_error", errorJson(run.at_keyframes)},
          {"coverage", run.coverage},
          {"posed", posedShare(run)},
          {"worlds", run.worlds},
          {"posed_in_any_world", posedShareInAnyWorld(run)},
          {"first_pose_s", optionalJson(run.first_pose_s)},
          {"keyframes", run.keyframes},
          {"map_points", run.map_points},
          {"recoveries", run.recoveries},
          {"relocalisations", run.relocalisations},
          {"loops", loops},
          {"states", run.states},
          {"tracking_ms", timesJson(stageOf(run, "tracking"))},
          {"total_ms", timesJson(stageOf(run, "total"))},
          {"recording_s", run.recording_s},
          {"wall_s", run.wall_s},
          {"real_time_ratio", run.real_time_ratio}};
}

std::optional<PublishedErrors> publishedFor(const SetRun& run) {
  std::optional<PublishedErrors> published = publishedErrors(run.input);
  if (!published && run.figures) published = publishedErrors(run.figures->sequence);
  return published;
}

std::string right(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

// A name from outside must not steer the terminal.
std::string plain(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

std::string errorText(const RunFigures& run, const std::optional<ErrorFigures>& error) {
  if (error) return formatted("%.2f", 100 * error->rmse_m);
  return run.has_ground_truth ? "X" : "-";
}

std::string tableLine(const SetRun& run, std::size_t name_width) {
  std::string line = plain(run.name);
  line.resize(std::max(name_width, line.size()), ' ');
  if (!run.figures) return line + "  failed: " + plain(run.message) + "\n";
  const RunFigures& f = *run.figures;
  const std::optional<PublishedErrors> published = publishedFor(run);
  const StageFigures* tracking = stageOf(f, "tracking");
  line +=
      right(errorText(f, f.trajectory), 9) + right(errorText(f, f.live), 9) + right(errorText(f, f.at_keyframes), 14);
  line += right(published ? published->edge_slam : "", 10) + right(formatted("%.1f", 100 * f.coverage), 9);
  line += right(formatted("%.1f", 100 * posedShare(f)), 9) + right(std::to_string(f.worlds), 6) +
          right(formatted("%.1f", 100 * posedShareInAnyWorld(f)), 11);
  line += right(f.first_pose_s ? formatted("%.1f", *f.first_pose_s) : "-", 9);
  line += right(std::to_string(f.recoveries), 12) + right(std::to_string(f.relocalisations), 17) +
          right(std::to_string(f.loops.size()), 7);
  line += right(tracking ? formatted("%.2f", tracking->median) : "-", 11) +
          right(tracking ? formatted("%.2f", tracking->percentile_99) : "-", 9) +
          right(formatted("%.2f", f.real_time_ratio), 13);
  return line + (run.failed ? "  failed: " + plain(run.message) : "") + "\n";
}

}  // namespace

std::string relativeLink(const std::string& page_folder, const std::string& path) {
  std::error_code error;
  namespace fs = std::filesystem;
  const fs::path base = fs::weakly_canonical(page_folder.empty() ? "." : page_folder, error);
  const std::string relative = fs::weakly_canonical(path, error).lexically_relative(base).generic_string();
  const std::string unreserved = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~/";
  std::string link;
  for (const char c : relative) {
    if (unreserved.find(c) != std::string::npos) {
      link += c;
    } else {
      link += formatted("%%%02X", static_cast<unsigned int>(static_cast<unsigned char>(c)));
    }
  }
  return link;
}

ordered_json setData(const RunSet& set) {
  ordered_json runs = ordered_json::array();
  for (const SetRun& run : set.runs) {
    runs.push_back({{"name", run.name},
                    {"link", run.link},
                    {"failed", run.failed},
                    {"message", run.message},
                    {"published", publishedJson(publishedFor(run))},
                    {"cpu_s", optionalJson(run.cpu_s)},
                    {"peak_mib", optionalJson(run.peak_mib)},
                    {"figures", run.figures ? figuresJson(*run.figures) : ordered_json()}});
  }
  return {{"note", set.note}, {"jobs", set.jobs}, {"runs", runs}};
}

std::string formatSetPage(const RunSet& set) {
  const PageAssets assets = pageAssets();
  const ReportAssets shared = reportAssets();
  const std::string title = escapedForHtml(set.title);
  const std::string data = escapedForScript(setData(set));
  return filledIn(assets.set_page, {{"title", title},
                                    {"style", shared.style},
                                    {"pages_style", assets.style},
                                    {"data", data},
                                    {"charts", shared.charts},
                                    {"tables", assets.tables},
                                    {"script", assets.set_script}});
}

std::string formatSetTable(const RunSet& set) {
  std::size_t width = 8;
  for (const SetRun& run : set.runs) width = std::max(width, run.name.size());
  std::string heading = "sequence";
  heading.resize(width, ' ');
  std::string table = heading +
                      " error cm  live cm  keyframes cm  paper cm  cover %  posed %  maps  any map %  start s  "
                      "recoveries  relocalisations" +
                      "  loops  tracking  99 % ms  x real time\n";
  for (const SetRun& run : set.runs) table += tableLine(run, width);
  return table;
}

}  // namespace edgeslam
