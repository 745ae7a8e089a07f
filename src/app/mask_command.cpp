#include "app/mask_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "app/command_line.h"
#include "app/output_file.h"
#include "calibration/mask_proposal.h"
#include "edgeslam/input_error.h"
#include "files/atomic_file.h"
#include "files/format_text.h"
#include "frames/image_file.h"
#include "geometry/camera_mask.h"
#include "image_formats/png.h"
#include "recording/open_frame_source.h"

namespace edgeslam {
namespace {

struct MaskOptions {
  std::string recording, output = "mask.png";
  bool force = false;
};

// Beside "mask.png" it is "mask_overlay.png".
std::string overlayPath(const std::string& output) {
  std::filesystem::path path(output);
  return path.replace_filename(path.stem().string() + "_overlay.png").string();
}

void writePng(const std::string& path, const cv::Mat& image) {
  const std::vector<unsigned char> png = encodePng(image);
  writeFileAtomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

struct FrameCounts {
  std::int64_t frames = 0, unreadable = 0;
};

FrameCounts readFrames(const std::string& recording, EdgeChanges& changes) {
  const std::unique_ptr<FrameSource> source = openFrameSource(recording);
  FrameCounts counts;
  std::string problem;
  while (const std::optional<Frame> frame = source->next()) {
    ++counts.frames;
    std::string wrong = frame->problem;
    if (wrong.empty()) wrong = sizeProblem(frame->grey.size(), changes.latestView().size(), "those before are");
    if (wrong.empty()) {
      changes.add(frame->grey);
    } else {
      ++counts.unreadable;
      problem = wrong;
    }
  }
  if (counts.unreadable > 0) {
    std::cerr << "edgeslam: " << counts.unreadable << " of " << counts.frames << " frames are left out: " << problem
              << "\n";
  }
  if (changes.views() == 0) throw InputError(recording + ": not one frame could be read");
  return counts;
}

int proposeMask(const MaskOptions& options) {
  refuseToReplace(options.output, options.force);
  EdgeChanges changes;
  const FrameCounts counts = readFrames(options.recording, changes);
  if (!changes.tellEnough()) {
    throw InputError(options.recording + ": the camera hardly moves: " + std::to_string(changes.views()) + " of " +
                     std::to_string(counts.frames) + " frames show something new, expected at least " +
                     std::to_string(EdgeChanges::fewest_views));
  }
  const cv::Mat image = changes.proposeMask();
  const auto mask = makeCameraMask(image);
  if (cv::countNonZero(mask->masked) == 0) {
    std::cerr << "edgeslam: " << options.recording
              << ": nothing stays the same while the camera moves: no mask is needed, none is written\n";
    return exit_failed;
  }
  if (!leavesSomething(*mask)) throw InputError(options.recording + ": everything stays the same in it");
  const std::string overlay = overlayPath(options.output);
  writePng(options.output, image);
  writePng(overlay, drawMask(changes.latestView(), image));
  std::cout << options.output
            << formatted(": %.1f %% of the image is masked, by %d of %lld frames that show something new; look at ",
                         100 * maskedShare(*mask), changes.views(), static_cast<long long>(counts.frames))
            << overlay << "\n";
  return exit_done;
}

}  // namespace

void addMaskCommand(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<MaskOptions>();
  CLI::App* command = app.add_subcommand(
      "mask", "Propose the image for camera.mask: what stays the same while the camera moves, as the robot's own body");
  command->add_option("RECORDING", options->recording, "Recording, video, or folder of images in which the robot turns")
      ->required();
  command->add_option("--output", options->output, "Mask to write (PNG); beside it a picture of it over a frame")
      ->capture_default_str();
  command->add_flag("--force", options->force, "Replace the file");
  command->callback([options, &exit_code] { exit_code = proposeMask(*options); });
}

}  // namespace edgeslam
