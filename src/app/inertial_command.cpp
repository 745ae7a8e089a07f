#include "app/inertial_command.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "app/command_line.h"
#include "app/output_file.h"
#include "app/replay_progress.h"
#include "calibration/board_pose.h"
#include "calibration/inertial_calibration.h"
#include "calibration/inertial_calibration_text.h"
#include "configuration/configuration.h"
#include "configuration/input_configuration.h"
#include "files/atomic_file.h"
#include "frames/frame_problem.h"
#include "inertia/inertial_history.h"
#include "pipeline/lockstep_run.h"
#include "recording/open_frame_source.h"
#include "recording/recording_source.h"

namespace edgeslam {
namespace {

// Without those that no run uses, either: beyond what any unit measures, or not after the one before.
std::vector<InertialSample> samplesBeside(const FrameSource& source) {
  std::vector<InertialSample> samples, usable;
  if (const Recording* recording = source.recording()) {
    for (const InertiaGiven& given : recording->decisions.inertia) samples.push_back(given.sample);
    if (samples.empty()) throw InputError(recording->folder + ": the run was recorded without inertial data");
  } else {
    samples = readInertialSamples(source.inertialFiles());
  }
  for (const InertialSample& sample : samples) {
    if (isUsable(sample) && (usable.empty() || sample.time_ns > usable.back().time_ns)) usable.push_back(sample);
  }
  return usable;
}

// The configuration's unit, or else the one beside the frames; without either the default noise.
KnownUnit unitBeside(const FrameSource& source, const Configuration& configuration) {
  if (configuration.inertia.has_unit) return {configuration.inertia.unit, true};
  const InertialFiles files = source.inertialFiles();
  if (source.recording() || files.unit.empty()) return {configuration.inertia.unit, false};
  return {readInertialRecording(files).unit, true};
}

Camera cameraOf(const FrameSource& source, Configuration configuration, const KnownUnit& known,
                const std::string& input) {
  const Camera camera = cameraFor(source, configuration, input);
  if (configuration.settings.mapping.camera_finding.lens_is_presumed) {
    throw InputError((configuration.source.empty() ? input : configuration.source) +
                     ": only the camera's size is known; an inertial unit is found with a calibrated camera only");
  }
  configuration.inertia.is_used = true;
  configuration.inertia.unit = known.unit;
  return withReadoutOfUnit(camera, configuration);
}

// As far as they can be read; frames that cannot be are told.
template <typename Take>
void forEachFrame(FrameSource& source, const Camera& camera, const Take& take) {
  while (const std::optional<Frame> frame = source.next()) {
    const std::string problem = frameProblem(*frame, camera);
    if (!problem.empty()) std::cerr << "edgeslam: frame " << frame->index << " skipped: " << problem << "\n";
    take(*frame, problem);
  }
}

// By the camera alone: what is known of the unit may be wrong.
std::vector<PosedCamera> posesInMap(FrameSource& source, const Camera& camera, Settings settings) {
  settings.wheels.enabled = false;
  LockstepRun run(camera, settings, source.size(), 0);
  ReplayProgress progress(source.size());
  std::int64_t count = 0, first_ns = 0;
  forEachFrame(source, camera, [&](const Frame& frame, const std::string& problem) {
    if (count++ == 0) first_ns = frame.time_ns;
    const FrameRecord& record = problem.empty() ? run.process(frame.index, frame.time_ns, frame.grey)
                                                : run.skip(frame.index, frame.time_ns, problem);
    progress.show(record, count, static_cast<double>(frame.time_ns - first_ns) * 1e-9);
  });
  progress.end();
  std::vector<PosedCamera> poses;
  for (const FrameRecord& record : run.finish().frames) {
    if (record.has_final_pose) poses.push_back({record.time_ns, record.final_world, record.final_world_T_camera});
  }
  return poses;
}

std::vector<PosedCamera> posesBeforeBoard(FrameSource& source, const Camera& camera, const Board& board) {
  std::vector<PosedCamera> poses;
  forEachFrame(source, camera, [&](const Frame& frame, const std::string& problem) {
    if (!problem.empty()) return;
    const std::optional<Pose> pose = cameraBeforeBoard(frame.grey, board, camera);
    if (!pose) return;
    const bool is_other_end =
        !poses.empty() && rotationAngle(pose->rotation, poses.back().world_T_camera.rotation) > M_PI / 2;
    poses.push_back({frame.time_ns, 0, is_other_end ? fromOtherEnd(board, *pose) : *pose});
  });
  return poses;
}

int refused(const InertialCommand& command, const std::string& problem) {
  std::cerr << "edgeslam: " << command.input << ": the recording does not tell how the unit sits: " << problem << "\n";
  return exit_failed;
}

}  // namespace

int calibrateUnit(const InertialCommand& command) {
  const std::unique_ptr<FrameSource> source = openFrameSource(command.input);
  const Configuration configuration = configurationFor(*source, command.configuration);
  const std::vector<InertialSample> samples = samplesBeside(*source);
  const KnownUnit known = unitBeside(*source, configuration);
  const Camera camera = cameraOf(*source, configuration, known, command.input);
  if (!command.output.empty()) refuseToReplace(command.output, command.force);
  const std::optional<Board> board = command.board.empty() ? std::nullopt : std::optional(parseBoard(command.board));
  const std::vector<PosedCamera> poses =
      board ? posesBeforeBoard(*source, camera, *board) : posesInMap(*source, camera, configuration.settings);
  if (poses.empty()) return refused(command, board ? "the board is found in no frame" : "no map came to stand");
  const InertialCalibration calibration = calibrateInertialUnit(poses, samples, known.unit);
  if (!calibration.problem.empty()) return refused(command, calibration.problem);
  std::cout << command.input << ": " << inertialSummary(known, calibration);
  if (!command.output.empty()) {
    writeFileAtomically(command.output, inertialUnitText(known, calibration, command.input));
    std::cout << command.output << " is written\n";
  }
  return exit_done;
}

}  // namespace edgeslam
