#include "app/simulate_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "edgeslam/input_error.h"
#include "simulator/simulator.h"
#include "simulator/simulator_folder.h"

namespace edgeslam {
namespace {

struct SimulateOptions {
  SimulationOptions simulation;
  std::string scene, output;
  std::vector<std::string> covered, shaken, still, turned, slipped;
  bool force = false;
};

std::vector<FrameRange> frameRanges(const std::vector<std::string>& texts) {
  std::vector<FrameRange> ranges;
  for (const std::string& text : texts) ranges.push_back(parseFrameRange(text));
  return ranges;
}

// One line that rewrites itself on a terminal; elsewhere a line every tenth of the way.
void showProgress(int done, int total, bool terminal) {
  if (terminal) {
    std::cerr << "\rframe " << done << " of " << total << (done == total ? "\n" : "") << std::flush;
  } else if (done * 10LL / total != (done - 1) * 10LL / total) {
    std::cerr << "frame " << done << " of " << total << "\n";
  }
}

int simulate(SimulateOptions options) {
  options.simulation.scene = sceneKindOfName(options.scene);
  options.simulation.covered = frameRanges(options.covered);
  options.simulation.shaken = frameRanges(options.shaken);
  options.simulation.still = frameRanges(options.still);
  options.simulation.turned = frameRanges(options.turned);
  options.simulation.slipped = frameRanges(options.slipped);
  if (!options.slipped.empty() && !options.simulation.wheels)
    throw InputError("--slip: only wheels slip, add --wheels");
  const SimulatedSequence sequence = makeSequence(options.simulation);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  writeSequence(sequence, options.output, options.force,
                [&](int done) { showProgress(done, sequence.size(), terminal); });
  std::cout << options.output << ": " << sequence.size() << " frames of " << options.scene << ", "
            << sequence.camera.width << " x " << sequence.camera.height << " px, with ground truth\n";
  return exit_done;
}

}  // namespace

void addSimulateCommand(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<SimulateOptions>();
  SimulationOptions& simulation = options->simulation;
  CLI::App* command = app.add_subcommand("simulate", "Make a sequence with exact ground truth");
  command->add_option("SCENE", options->scene, "panels, panels_textured, room, corridor or corridor_tiled")->required();
  command->add_option("--output", options->output, "Folder to write, in TUM layout")->required();
  command->add_option("--frames", simulation.frames,
                      "Number of frames; 0: 300, for the corridor a lap and a little more");
  command->add_option("--seed", simulation.seed, "Of posters, hand and noise; the same seed gives the same bytes")
      ->capture_default_str();
  command->add_option("--fps", simulation.fps, "Frames a second")->capture_default_str();
  command->add_option("--width", simulation.width, "Image width [px]")->capture_default_str();
  command->add_option("--height", simulation.height, "Image height [px]")->capture_default_str();
  command->add_flag("--fisheye", simulation.fisheye, "Fisheye lens (Kannala-Brandt)");
  command->add_option("--exposure", simulation.exposure_ms, "Exposure time [ms]; 0: no motion blur")
      ->capture_default_str();
  command
      ->add_option("--readout", simulation.readout_ms,
                   "Rolling shutter: time from the first row's exposure to the last one's [ms], -200 to 200 and no "
                   "longer than from one frame to the next; 0: global shutter; negative: the last row comes first")
      ->capture_default_str();
  command->add_option("--noise", simulation.noise, "Standard deviation of the noise at grey 128")
      ->capture_default_str();
  command->add_option("--speed", simulation.speed, "Speed along the path; 1: the scene's usual")->capture_default_str();
  command->add_option("--cover", options->covered, "Frames with a hand on the lens, FIRST:COUNT; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--shake", options->shaken, "Frames in which the camera is shaken, FIRST:COUNT; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--still", options->still, "Frames in which the camera stands still, FIRST:COUNT; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--turn", options->turned,
                   "Frames in which the camera turns on the spot, to the side and back, FIRST:COUNT; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--turn-angle", simulation.turn_deg, "How far it turns then [deg], -180 to 180")
      ->capture_default_str();
  command->add_flag("--imu", simulation.inertia,
                    "Inertial data beside the frames: imu.csv at 200 Hz with noise and biases, and imu.yaml");
  command->add_flag("--wheels", simulation.wheels,
                    "What wheels beneath the camera would say beside the frames, with noise: wheel_odometry.txt");
  command
      ->add_option("--slip", options->slipped,
                   "With --wheels: frames in which the wheels spin, FIRST:COUNT; may be repeated")
      ->allow_extra_args(false);
  command->add_flag("--force", options->force, "Write to a folder that is not empty");
  command->callback([options, &exit_code] { exit_code = simulate(*options); });
}

}  // namespace edgeslam
