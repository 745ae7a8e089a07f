#include "app/record_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "app/camera_recording.h"
#include "app/command_line.h"
#include "app/end_signals.h"
#include "configuration/configuration.h"
#include "drivers/cameras/open_camera.h"
#include "frames/calibration_file.h"

namespace edgeslam {
namespace {

struct RecordOptions {
  std::string device, configuration, calibration, output;
  std::int64_t frames = 0;
  double seconds = 0;
  double free_mib = 256;
};

std::string summary(const CameraRecordingCounts& counts, std::int64_t bytes) {
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << counts.written << " frames, " << static_cast<double>(counts.duration_ns) * 1e-9 << " s, "
       << static_cast<double>(bytes) / (1 << 20) << " MiB";
  if (counts.lost_by_driver > 0) text << ", " << counts.lost_by_driver << " lost by the driver";
  if (counts.lost_by_disk > 0) text << ", " << counts.lost_by_disk << " lost as the disk was too slow";
  if (counts.damaged > 0) text << ", " << counts.damaged << " damaged";
  if (counts.interruptions > 0) text << ", " << counts.interruptions << " interruptions";
  if (counts.arrival_stamps > 0) text << ", " << counts.arrival_stamps << " with the time of arrival only";
  return text.str();
}

// One line that rewrites itself on a terminal; elsewhere a line every 10 s.
class Progress {
 public:
  void show(const CameraRecordingCounts& counts) {
    const std::int64_t step_ns = terminal_ ? 200'000'000 : 10'000'000'000;
    if (counts.duration_ns - shown_ns_ < step_ns) return;
    shown_ns_ = counts.duration_ns;
    std::cerr << (terminal_ ? "\r" : "") << counts.written << " frames, " << counts.duration_ns / 1'000'000'000 << " s"
              << (terminal_ ? " (Ctrl-C ends)" : "\n") << std::flush;
  }
  void tell(const std::string& message) const {
    std::cerr << (terminal_ ? "\n" : "") << "edgeslam: " << message << std::endl;
  }
  void end() const {
    if (terminal_) std::cerr << "\n";
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::int64_t shown_ns_ = 0;
};

struct Session {
  CameraOptions camera;
  std::optional<Camera> calibration;
};

Session sessionOf(const RecordOptions& options) {
  Session session;
  std::optional<double> readout_s;
  if (!options.configuration.empty()) {
    const Configuration configuration = readConfiguration(options.configuration);
    session = {configuration.capture, configuration.camera};
    readout_s = configuration.readout_s;
  }
  if (!options.calibration.empty()) session.calibration = readCalibration(options.calibration);
  session.camera.readout_s = readout_s.value_or(session.calibration ? session.calibration->readout_s : 0);
  if (!options.device.empty()) session.camera.device = options.device;
  if (session.calibration && session.camera.width == 0) {
    session.camera.width = session.calibration->width;
    session.camera.height = session.calibration->height;
  }
  session.camera.every_frame = true;
  session.camera.buffers = 8;
  return session;
}

int record(const RecordOptions& options) {
  const Session session = sessionOf(options);
  const std::unique_ptr<ReopeningCamera> camera = openLastingCamera(session.camera);
  const StreamDescription& stream = camera->stream();
  if (session.calibration &&
      (session.calibration->width != stream.width || session.calibration->height != stream.height)) {
    throw InputError("the calibration is for " + std::to_string(session.calibration->width) + " x " +
                     std::to_string(session.calibration->height) + " pixels, " + stream.camera + " gives " +
                     stream.format);
  }
  EndSignals signals;  // before the writing thread, which inherits it
  FrameFolderWriter writer(options.output, session.calibration, stream.camera + ", " + stream.format,
                           static_cast<std::int64_t>(options.free_mib * (1 << 20)));
  std::cerr << "recording " << stream.camera << ", " << stream.format << ", to " << options.output
            << (session.calibration ? "" : ", without a calibration (none is configured)") << std::endl;
  Progress progress;
  const CameraRecordingResult result = recordCamera(
      *camera, writer, {options.frames, std::llround(options.seconds * 1e9), 90}, [&] { return signals.came(); },
      [&](const std::string& message) { progress.tell(message); },
      [&](const CameraRecordingCounts& counts) { progress.show(counts); });
  progress.end();
  std::cout << options.output << ": " << summary(result.counts, writer.bytes()) << "\n";
  if (!result.problem.empty()) throw InputError(result.problem + "; what was written before is whole");
  return result.counts.written > 0 ? exit_done : exit_failed;
}

}  // namespace

void addRecordCommand(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand("record", "Record a camera's frames with their times");
  command->add_option("DEVICE", options->device, "The camera, as `edgeslam cameras` names it; or the configuration's");
  command->add_option("--output", options->output, "Folder to write, in TUM layout; must not be there, or be empty")
      ->required();
  command->add_option("--config", options->configuration, "Configuration (YAML): capture and camera");
  command->add_option("--calibration", options->calibration, "Calibration to put beside the frames (YAML)");
  command->add_option("--frames", options->frames, "End after as many frames")->check(CLI::Range(1LL, 1'000'000'000LL));
  command->add_option("--seconds", options->seconds, "End after this time [s]")->check(CLI::Range(0.001, 1e9));
  command->add_option("--keep-free", options->free_mib, "Disk space to leave free [MiB]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e9));
  command->callback([options, &exit_code] { exit_code = record(*options); });
}

}  // namespace edgeslam
