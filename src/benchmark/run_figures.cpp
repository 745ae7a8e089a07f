#include "benchmark/run_figures.h"

#include <cmath>

#include "benchmark/json_reader.h"

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

double finiteElement(const JsonReader& error, const std::string& key, std::size_t index, std::size_t count) {
  const std::string expected = std::to_string(count) + " finite numbers";
  const ordered_json& values = error.array(key);
  if (values.size() != count || !values[index].is_number()) error.fail(key, expected);
  const auto value = values[index].get<double>();
  if (!(std::abs(value) <= 1e15)) error.fail(key, expected);
  return value;
}

// Runs of older versions tell the scale alone.
std::optional<Similarity> alignmentOf(const JsonReader& error) {
  const double scale = error.number("scale");
  if (!error.has("rotation_wxyz") || !error.has("translation_m")) return std::nullopt;
  const auto q = [&](std::size_t i) { return finiteElement(error, "rotation_wxyz", i, 4); };
  const auto t = [&](std::size_t i) { return finiteElement(error, "translation_m", i, 3); };
  Similarity similarity;
  similarity.scale = scale;
  similarity.rotation = Eigen::Quaterniond(q(0), q(1), q(2), q(3));
  if (std::abs(similarity.rotation.norm() - 1) > 1e-6) error.fail("rotation_wxyz", "a unit quaternion");
  similarity.translation = {t(0), t(1), t(2)};
  return similarity;
}

std::optional<ErrorFigures> errorOf(const JsonReader& parent, const std::string& key) {
  if (parent.isNull(key)) return std::nullopt;
  const JsonReader error = parent.object(key);
  ErrorFigures figures;
  figures.pairs = error.count("pairs");
  figures.rmse_m = error.number("rmse_m");
  figures.mean_m = error.number("mean_m");
  figures.median_m = error.number("median_m");
  figures.max_m = error.number("max_m");
  figures.reference_T_world = alignmentOf(error);
  return figures;
}

void readStates(const JsonReader& summary, RunFigures& run) {
  const JsonReader states = summary.object("states");
  for (const auto& [name, count] : states.json().items()) run.states[name] = states.count(name);
  for (const auto& [name, count] : run.states) {
    if (count > run.frames) states.fail(name, "at most frames.total, " + std::to_string(run.frames));
  }
}

void readLoops(const JsonReader& summary, RunFigures& run) {
  for (std::size_t i = 0; i < summary.array("closed_loops").size(); ++i) {
    const JsonReader loop = summary.element("closed_loops", i);
    LoopFigures figures;
    figures.frame = loop.count("frame");
    figures.how = loop.text("how");
    if (loop.has("keyframe_error_before")) figures.before = errorOf(loop, "keyframe_error_before");
    if (loop.has("keyframe_error_after")) figures.after = errorOf(loop, "keyframe_error_after");
    run.loops.push_back(figures);
  }
}

void readErrors(const JsonReader& summary, RunFigures& run) {
  run.has_ground_truth = !summary.isNull("absolute_trajectory_error");
  if (!run.has_ground_truth) return;
  const JsonReader errors = summary.object("absolute_trajectory_error");
  run.trajectory = errorOf(errors, "trajectory");
  run.live = errorOf(errors, "live");
  run.at_keyframes = errorOf(errors, "keyframes");
}

void readTimes(const JsonReader& summary, RunFigures& run) {
  const JsonReader stages = summary.object("stage_times_ms");
  for (const auto& [name, times] : stages.json().items()) {
    const JsonReader stage = stages.object(name);
    run.stages.push_back({name, stage.count("frames"), stage.number("mean"), stage.number("p50"), stage.number("p99"),
                          stage.number("max")});
  }
  run.recording_s = summary.number("recording_s");
  run.wall_s = summary.number("wall_s");
  run.real_time_ratio = summary.number("real_time_ratio");
}

// Summaries of older versions know one world.
void readWorlds(const JsonReader& summary, RunFigures& run) {
  run.with_pose_in_any_world = run.with_pose;
  if (!summary.has("worlds")) return;
  run.worlds = static_cast<std::int64_t>(summary.array("worlds").size());
  run.with_pose_in_any_world = 0;
  for (std::size_t i = 0; i < summary.array("worlds").size(); ++i) {
    const JsonReader world = summary.element("worlds", i);
    const std::int64_t frames = world.count("frames_with_pose");
    if (frames > run.frames - run.with_pose_in_any_world) {
      world.fail("frames_with_pose", "at most frames.total, " + std::to_string(run.frames) + ", in all worlds");
    }
    run.with_pose_in_any_world += frames;
  }
}

double shareOf(std::int64_t count, std::int64_t all) {
  return all > 0 ? static_cast<double>(count) / static_cast<double>(all) : 0;
}

void readCounts(const JsonReader& summary, RunFigures& run) {
  const JsonReader frames = summary.object("frames");
  run.frames = frames.count("total");
  run.unreadable = frames.count("unreadable");
  run.dropped = frames.count("dropped");
  run.with_pose = frames.count("with_pose");
  run.with_live_pose = frames.count("with_live_pose");
  run.coverage = summary.number("coverage_from_first_pose");
  if (run.coverage > 1) summary.fail("coverage_from_first_pose", "a share of 0 to 1");
  run.first_pose_s = summary.numberOrNull("first_pose_s");
  run.first_live_pose_s = summary.numberOrNull("first_live_pose_s");
  run.keyframes = summary.count("keyframes");
  run.map_points = summary.count("map_points");
  run.recoveries = summary.count("recoveries");
  run.relocalisations = summary.count("relocalisations");
}

void readDescription(const JsonReader& summary, RunFigures& run) {
  run.sequence = summary.text("sequence");
  run.input = summary.text("input");
  run.command_line = summary.text("command_line");
  run.initialisation = summary.text("initialisation");
  const JsonReader versions = summary.object("versions");
  run.program_version = versions.text("edgeslam");
  const JsonReader libraries = versions.object("libraries");
  for (const auto& [name, version] : libraries.json().items()) run.library_versions[name] = libraries.text(name);
  run.configuration = summary.text("configuration");
}

}  // namespace

double posedShare(const RunFigures& run) { return shareOf(run.with_pose, run.frames); }

double posedShareInAnyWorld(const RunFigures& run) { return shareOf(run.with_pose_in_any_world, run.frames); }

const StageFigures* stageOf(const RunFigures& run, const std::string& name) {
  for (const StageFigures& stage : run.stages) {
    if (stage.name == name) return &stage;
  }
  return nullptr;
}

RunFigures readRunFigures(const std::string& folder) {
  const std::string path = folder + "/summary.json";
  const ordered_json json = readJsonObject(path);
  const JsonReader summary(path, json);
  RunFigures run;
  readDescription(summary, run);
  readCounts(summary, run);
  readWorlds(summary, run);
  readStates(summary, run);
  readLoops(summary, run);
  readErrors(summary, run);
  readTimes(summary, run);
  return run;
}

}  // namespace edgeslam
