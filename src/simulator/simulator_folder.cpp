#include "simulator/simulator_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "edgeslam/input_error.h"
#include "evaluation/trajectory.h"
#include "files/format_text.h"
#include "files/text_file.h"
#include "image_formats/png.h"
#include "simulator/inertial_simulation.h"
#include "simulator/wheel_simulation.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

InputError writeError(const fs::path& path, int error) {
  return InputError(path.string() + ": cannot be written: " + std::generic_category().message(error));
}

void writeFile(const fs::path& path, const void* content, std::size_t size) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (!file) throw writeError(path, errno);
  int error = std::fwrite(content, 1, size, file) == size ? 0 : errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;
  if (error != 0) throw writeError(path, error);
}

void writeFile(const fs::path& path, const std::string& text) { writeFile(path, text.data(), text.size()); }

// Removes what it names unless told to keep it.
struct Removal {
  fs::path path;
  bool keep = false;
  explicit Removal(fs::path what) : path(std::move(what)) {}
  Removal(const Removal&) = delete;
  Removal& operator=(const Removal&) = delete;
  ~Removal() {
    std::error_code ignored;
    if (!keep && !path.empty()) fs::remove_all(path, ignored);
  }
};

// The outermost folder of `folder`'s path that has to be made, or an empty path.
fs::path firstMissing(const fs::path& folder) {
  fs::path missing;
  std::error_code ignored;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored); path = path.parent_path()) missing = path;
  return missing;
}

void writeContents(const SimulatedSequence& sequence, const fs::path& folder,
                   const std::function<void(int)>& progress) {
  const std::string source = std::string("simulated scene ") + sceneName(sequence.options.scene) + ", seed " +
                             std::to_string(sequence.options.seed) + "\n";
  std::string list = "# " + source + "# timestamp filename\n";
  Trajectory trajectory;
  for (int i = 0; i < sequence.size(); ++i) {
    const SimulatedFrame frame = sequence.frame(i);
    const std::string stamp = formatStamp(frame.time_ns), name = "rgb/" + stamp + ".png";
    const std::vector<unsigned char> png = encodePng(frame.grey, PngEffort::small);
    writeFile(folder / name, png.data(), png.size());
    list.append(stamp).append(" ").append(name).append("\n");
    trajectory.push_back({frame.time_ns, frame.world_T_camera});
    if (progress) progress(i + 1);
  }
  writeFile(folder / "rgb.txt", list);
  writeFile(folder / "groundtruth.txt",
            "# ground truth: camera (x right, y down, z forward) to world [m], middle of the exposure\n" +
                formatTrajectory(trajectory));
  writeFile(folder / "camera.yaml", formatCalibration(sequence.camera, sequence.options));
  writeFile(folder / "surfaces.txt", formatSurfaces(sequence.scene.scene));
  if (sequence.options.wheels) {
    writeFile(folder / "wheel_odometry.txt", formatWheelOdometry(simulateWheels(sequence)));
  }
  if (!sequence.options.inertia) return;
  writeFile(folder / "imu.csv", formatInertialSamples(simulateInertia(sequence)));
  writeFile(folder / "imu.yaml", formatInertialUnit(simulatedUnit()));
}

}  // namespace

std::string formatCalibration(const Camera& camera, const SimulationOptions& options) {
  const bool fisheye = camera.model == CameraModel::kannala_brandt;
  std::string text = std::string("# simulated scene ") + sceneName(options.scene) + "\n";
  if (fisheye) text += "model: kannala_brandt\n";
  const auto append = [&text](const char* key, double value) { text += formatted("%s: %.10g\n", key, value); };
  append("width", camera.width);
  append("height", camera.height);
  append("fx", camera.fx);
  append("fy", camera.fy);
  append("cx", camera.cx);
  append("cy", camera.cy);
  append("k1", camera.distortion[0]);
  append("k2", camera.distortion[1]);
  append(fisheye ? "k3" : "p1", camera.distortion[2]);
  append(fisheye ? "k4" : "p2", camera.distortion[3]);
  if (camera.readout_s != 0) append("readout", camera.readout_s);
  append("fps", options.fps);
  return text;
}

void writeSequence(const SimulatedSequence& sequence, const std::string& folder_name, bool force,
                   const std::function<void(int)>& progress) {
  const fs::path folder = fs::path(folder_name).lexically_normal();
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) throw writeError(folder, ENOTDIR);
  if (!force && fs::exists(folder, error) && !fs::is_empty(folder, error)) {
    throw InputError(folder.string() +
                     ": the output folder is not empty; --force replaces what a simulation writes there");
  }
  Removal made(firstMissing(folder));
  // Everything is written beside its place and moved there once it is whole.
  Removal partial(folder / ".simulate-partial");
  fs::remove_all(partial.path, error);
  fs::create_directories(partial.path / "rgb", error);
  if (error) throw writeError(folder, error.value());
  writeContents(sequence, partial.path, progress);
  for (const char* name : {"rgb", "rgb.txt", "groundtruth.txt", "camera.yaml", "surfaces.txt", "imu.csv", "imu.yaml",
                           "wheel_odometry.txt"}) {
    fs::remove_all(folder / name, error);
    if (!error && fs::exists(partial.path / name)) fs::rename(partial.path / name, folder / name, error);
    if (error) throw writeError(folder / name, error.value());
  }
  made.keep = true;
}

}  // namespace edgeslam
