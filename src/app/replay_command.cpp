#include "app/replay_command.h"

#include <ceres/version.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <opencv2/core/version.hpp>

#include "app/command_line.h"
#include "app/measured_beside.h"
#include "app/replay_outcome.h"
#include "app/replay_progress.h"
#include "configuration/configuration.h"
#include "configuration/configuration_text.h"
#include "configuration/input_configuration.h"
#include "files/format_text.h"
#include "frames/frame_problem.h"
#include "inertia/found_time_offset.h"
#include "map/saved_map.h"
#include "pipeline/lockstep_run.h"
#include "recording/open_frame_source.h"
#include "recording/recording_source.h"
#include "report/run_files.h"
#include "samples/sample_feed.h"
#include "service/live_replay.h"
#include "service/memory_reserve.h"
#include "service/run_publisher.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

struct ReplayArguments {
  std::string input;
  std::string configuration;
  std::string output = "result";
  std::string map_in, map_out;
  bool imu = false;
  bool wheels = false;
  bool realtime = false;
  bool lcm = false;
  double pace = 1;
  std::string record;
  int drawings = 12;
};

RunDescription describe(const ReplayArguments& arguments, const Configuration& configuration) {
  RunDescription description;
  description.input = arguments.input;
  description.sequence = std::filesystem::path(arguments.input).lexically_normal().filename().string();
  if (description.sequence.empty()) {
    description.sequence = std::filesystem::path(arguments.input).lexically_normal().parent_path().filename().string();
  }
  description.program_version = EDGESLAM_VERSION;
  description.library_versions["OpenCV"] = CV_VERSION;
  description.library_versions["Ceres"] = CERES_VERSION_STRING;
  description.library_versions["Eigen"] = std::to_string(EIGEN_WORLD_VERSION) + "." +
                                          std::to_string(EIGEN_MAJOR_VERSION) + "." +
                                          std::to_string(EIGEN_MINOR_VERSION);
  description.configuration = formatConfiguration(configuration);
  description.command_line =
      "edgeslam replay " + arguments.input +
      (arguments.configuration.empty() ? "" : " --config " + arguments.configuration) +
      (arguments.map_in.empty() ? "" : " --map-in " + arguments.map_in) +
      (arguments.map_out.empty() ? "" : " --map-out " + arguments.map_out) + (arguments.imu ? " --imu" : "") +
      (arguments.wheels ? " --wheels" : "") + (arguments.realtime ? " --realtime" : "") +
      (arguments.pace != 1 ? " --pace " + std::to_string(arguments.pace) : "") + (arguments.lcm ? " --lcm" : "") +
      (arguments.record.empty() ? "" : " --record " + arguments.record) + " --output " + arguments.output;
  return description;
}

void tellSkipped(std::int64_t index, const std::string& problem, const ReplayProgress& progress) {
  progress.end();
  std::cerr << "edgeslam: frame " << index << " skipped: " << problem << "\n";
}

// Before anything is made of frames that cannot have been read so slowly.
void requireReadoutWithin(const Camera& camera, double frame_interval_s) {
  if (std::abs(camera.readout_s) <= frame_interval_s) return;
  throw InputError(
      formatted("the calibration's readout is %.4g s, but a frame comes every %.4g s: rows are read in "
                "less time than that; is it in seconds?",
                camera.readout_s, frame_interval_s));
}

void processAll(FrameSource& source, const Camera& camera, const MeasuredBeside& measured, const Settings& settings,
                const MemoryReserve& reserve, LockstepRun& run) {
  const std::int64_t offset_ns = settings.tracking.inertia ? settings.tracking.inertia->offset_ns : 0;
  SampleFeed inertia(measured.inertia, offset_ns + farthest_time_offset_ns);  // it may be found to be later
  SampleFeed wheels(measured.wheels);
  ReplayProgress progress(source.size());
  std::int64_t count = 0, first_ns = 0;
  while (std::optional<Frame> frame = reserve.isUsed() ? std::nullopt : source.next()) {
    if (count++ == 0) first_ns = frame->time_ns;
    if (count == 2) requireReadoutWithin(camera, static_cast<double>(frame->time_ns - first_ns) * 1e-9);
    const std::string problem = frameProblem(*frame, camera);
    if (!problem.empty()) tellSkipped(frame->index, problem, progress);
    inertia.giveUntil(frame->time_ns, [&](const InertialSample& sample) { run.add(sample); });
    wheels.giveUntil(frame->time_ns, [&](const OdometryPose& pose) { run.add(pose); });
    const FrameRecord& record = problem.empty() ? run.process(frame->index, frame->time_ns, frame->grey)
                                                : run.skip(frame->index, frame->time_ns, problem);
    progress.show(record, count, static_cast<double>(frame->time_ns - first_ns) * 1e-9);
  }
  progress.end();
}

void saveMapOf(const Map& map, const Camera& camera, const std::string& path) {
  if (map.points.empty()) {
    std::cerr << "edgeslam: " << path << " is not written: no map came to stand\n";
  } else {
    saveMap(path, camera, map);
  }
}

// With what was mapped until then; there are no results of half a run.
[[noreturn]] void endWithoutMemory(const Map& map, const Camera& camera, const std::string& map_out) {
  if (!map_out.empty() && !map.points.empty()) {
    saveMap(map_out, camera, map);
    std::cerr << "edgeslam: map of " << map.keyframes.size() << " keyframes saved to " << map_out
              << ", as it was when memory ran out\n";
  }
  throw std::bad_alloc();
}

// A run and the map that it leaves.
struct Replayed {
  RunResult result;
  Map map;
};

// A recording brings the map that its run went on with. Empty: none.
std::string mapToGoOnWith(const ReplayArguments& arguments, const FrameSource& source, const Settings& settings) {
  if (!arguments.map_in.empty()) return arguments.map_in;
  const Recording* recording = arguments.realtime ? nullptr : source.recording();
  const std::string brought = recording ? recording->folder + "/" + recording_map_name : "";
  if (!brought.empty() && std::filesystem::exists(brought)) return brought;
  if (settings.tracking.map_is_frozen) {
    throw InputError((arguments.configuration.empty() ? arguments.input : arguments.configuration) +
                     ": map.frozen: there is no map to localise in; give one (--map-in)");
  }
  return "";
}

Replayed replayInLockstep(FrameSource& source, const Camera& camera, const Settings& settings,
                          const MeasuredBeside& measured, const ReplayArguments& arguments) {
  const MemoryReserve reserve;
  LockstepRun run(camera, settings, source.size(), arguments.drawings);
  if (const Recording* recording = source.recording()) {
    const Decisions& decisions = recording->decisions;
    if (!decisions.note.empty()) std::cerr << "edgeslam: " << decisions.note << "\n";
    if (decisions.not_recorded == 0) run.repeat(runDecisions(decisions));
  }
  if (const std::string map = mapToGoOnWith(arguments, source, settings); !map.empty())
    run.goOnWith(loadMap(map, camera));
  processAll(source, camera, measured, settings, reserve, run);
  if (reserve.isUsed()) endWithoutMemory(run.map(), camera, arguments.map_out);
  Replayed replayed;
  replayed.result = run.finish();
  replayed.map = run.map();
  return replayed;
}

Replayed replayInRealTime(FrameSource& source, const Camera& camera, const Configuration& configuration,
                          MeasuredBeside measured, const ReplayArguments& arguments) {
  LiveReplay replay;
  replay.inertia = std::move(measured.inertia);
  replay.wheels = std::move(measured.wheels);
  const std::string map = mapToGoOnWith(arguments, source, configuration.settings);
  if (!map.empty()) replay.map_in = loadMap(map, camera);
  replay.record_folder = arguments.record;
  replay.pace = arguments.pace;
  replay.description = {camera, formatRecordedConfiguration(configuration), EDGESLAM_VERSION};
  ReplayProgress progress(source.size());
  std::int64_t count = 0, first_ns = 0;
  replay.progress = [&](const FrameResult& frame, const std::string& problem) {
    if (count++ == 0) first_ns = frame.time_ns;
    if (!problem.empty()) tellSkipped(frame.index, problem, progress);
    progress.show(frame, count, static_cast<double>(frame.time_ns - first_ns) * 1e-9);
  };
  CaptureLink link;
  EventLog log(std::cerr);
  std::unique_ptr<RunPublisher> publisher;
  if (arguments.lcm) publisher = std::make_unique<RunPublisher>(publishingSetup(configuration, camera), link, log);
  replay.publisher = publisher.get();
  const MemoryReserve reserve;
  replay.is_to_end = [&] { return reserve.isUsed(); };
  LiveReplayResult live = replayLive(source, camera, configuration.settings, replay);
  progress.end();
  if (reserve.isUsed()) endWithoutMemory(live.map, camera, arguments.map_out);
  if (!live.recording.empty()) std::cerr << "edgeslam: " << arguments.record << ": " << live.recording << "\n";
  return {std::move(live.run), std::move(live.map)};
}

// Told before a long run rather than after it.
void requireWritable(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path existing = fs::absolute(folder, error).lexically_normal();
  while (!fs::exists(existing, error) && existing.has_parent_path() && existing != existing.parent_path()) {
    existing = existing.parent_path();
  }
  if (!fs::is_directory(existing, error)) {
    throw InputError(folder + ": cannot be made a folder for the results: " + existing.string() + " is not a folder");
  }
  if (access(existing.c_str(), W_OK | X_OK) != 0) {
    throw InputError(folder + ": results cannot be written there: no permission to write in " + existing.string());
  }
}

int runReplay(const ReplayArguments& arguments) {
  if (arguments.pace != 1 && !arguments.realtime) {
    throw InputError("--pace: only what runs live has a pace, add --realtime");
  }
  if (!arguments.record.empty() && !arguments.realtime) {
    throw InputError("--record: only what runs live can be recorded, add --realtime");
  }
  if (arguments.lcm && !arguments.realtime) {
    throw InputError("--lcm: only what runs live is published, add --realtime");
  }
  const std::unique_ptr<FrameSource> source = openFrameSource(arguments.input);
  Configuration configuration = configurationFor(*source, arguments.configuration);
  const Camera calibrated = cameraFor(*source, configuration, arguments.input);
  if (const std::string presumed = presumedLens(configuration); !presumed.empty()) {
    std::cerr << "edgeslam: " << presumed << "\n";
  }
  if (const std::string doubt = calibrationDoubt(source->camera(), configuration); !doubt.empty()) {
    std::cerr << "edgeslam: " << doubt << "\n";
  }
  const MeasuredBeside measured =
      measuredBeside(*source, {arguments.imu, arguments.wheels, arguments.realtime}, configuration);
  const Camera camera = withReadoutOfUnit(calibrated, configuration);
  std::optional<Trajectory> ground_truth;
  if (!source->groundTruthPath().empty()) ground_truth = readTrajectory(source->groundTruthPath());

  requireWritable(arguments.output);
  if (!arguments.map_out.empty()) requireMapCanBeSaved(arguments.map_out);
  const auto start = std::chrono::steady_clock::now();
  Replayed replayed = arguments.realtime
                          ? replayInRealTime(*source, camera, configuration, measured, arguments)
                          : replayInLockstep(*source, camera, configuration.settings, measured, arguments);
  RunResult& result = replayed.result;
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.unreadable_frames == static_cast<std::int64_t>(result.frames.size())) {
    throw InputError(arguments.input + ": not one frame could be read");
  }
  writeRunFiles(arguments.output, result, describe(arguments, configuration), ground_truth);
  tellOutcome(result, ground_truth, arguments.output);
  // Last: where the map cannot be written, the results are there all the same.
  if (!arguments.map_out.empty()) saveMapOf(replayed.map, camera, arguments.map_out);
  const bool any_pose = std::any_of(result.frames.begin(), result.frames.end(),
                                    [](const FrameRecord& frame) { return frame.has_final_pose; });
  return any_pose ? exit_done : exit_failed;
}

}  // namespace

void addReplayCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReplayArguments>();
  // A script's variable that was never set.
  const auto named = [](const std::string& name) { return std::string(name.empty() ? "expected a file's name" : ""); };
  CLI::App* command =
      app.add_subcommand("replay", "Run over recorded frames: trajectory, map, error figures and a report");
  command
      ->add_option("INPUT", arguments->input,
                   "TUM RGB-D, ICL-NUIM or EuRoC folder, folder with a video and times.txt, folder of images named by "
                   "time stamp, video file, or recording of a live run, which is then repeated to the last bit")
      ->required();
  command->add_option("--config", arguments->configuration, "Configuration file (YAML); without it the defaults");
  command->add_option("--output", arguments->output, "Folder for the results")->capture_default_str();
  command
      ->add_option("--map-in", arguments->map_in,
                   "Saved map of the same camera: frames are found in it, and it is extended, or with map.frozen only "
                   "localised in")
      ->check(named);
  command->add_option("--map-out", arguments->map_out, "File to save the map to at the end")->check(named);
  command->add_flag(
      "--realtime", arguments->realtime,
      "Run at the pace of the time stamps, as on the robot; frames that the computer is too slow for are dropped");
  command->add_flag(
      "--imu", arguments->imu,
      "Use the inertial data beside the frames (imu.csv with imu.yaml, or EuRoC's imu0): metres, z up, and "
      "poses through blur");
  command->add_flag(
      "--wheels", arguments->wheels,
      "Use the wheels' odometry beside the frames (wheel_odometry.txt, of the body that camera.body_T_camera is on): "
      "metres, and poses where the camera sees nothing");
  command->add_flag("--lcm", arguments->lcm, "With --realtime: publish over LCM, as `edgeslam run` does");
  command
      ->add_option("--pace", arguments->pace,
                   "With --realtime: how many times as fast; 2 plays a recording of 30 frames/s at 60")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 20.0));
  command->add_option("--record", arguments->record, "With --realtime: folder for a recording that repeats this run")
      ->check(named);
  command->add_option("--drawings", arguments->drawings, "Frames drawn with edges and tracks in the report")
      ->capture_default_str()
      ->check(CLI::Range(0, 200));
  command->callback([arguments, &exit_code] { exit_code = runReplay(*arguments); });
}

}  // namespace edgeslam
