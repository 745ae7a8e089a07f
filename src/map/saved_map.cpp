#include "map/saved_map.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>

#include "edgeslam/input_error.h"
#include "files/atomic_file.h"
#include "files/format_text.h"
#include "geometry/millionths.h"
#include "map/map_check.h"

namespace edgeslam {
namespace {

std::string readWhole(const std::string& path) {
  constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 33;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": expected a saved map, this is no file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > largest_file) throw InputError(path + ": too large for a map");
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  const auto readTo = [&](std::uintmax_t end) {
    const std::size_t begin = bytes.size();
    bytes.resize(static_cast<std::size_t>(end));
    if (!file || !file.read(&bytes[begin], static_cast<std::streamsize>(end - begin)))
      throw InputError(path + ": cannot be read");
  };
  // A film given by mistake is not read to its end.
  readTo(std::min<std::uintmax_t>(size, 16));
  if (bytes == encodeMap(SavedMap()).substr(0, bytes.size())) readTo(size);
  return bytes;
}

// What the run that saved a map found beside this calibration; none where its camera was another one.
std::optional<FoundCamera> foundBeside(const Camera& calibrated, const Camera& saved) {
  constexpr double most_focal_change = 0.3, most_radial_change = 2, tolerance = 1e-12;
  constexpr double most_principal_point_change = 0.1;  // of the longer side
  FoundCamera found;
  if (calibrated.readout_s == 0 && saved.readout_s != 0) found.readout_s = saved.readout_s;
  found.focal_scale = inMillionths(saved.fx / calibrated.fx);
  if (!(std::abs(found.focal_scale - 1) <= most_focal_change)) return std::nullopt;
  for (std::size_t k = 0; k < found.radial.size(); ++k) {
    found.radial[k] = inMillionths(saved.distortion[k] - calibrated.distortion[k]);
    if (!(std::abs(found.radial[k]) <= most_radial_change)) return std::nullopt;
  }
  found.principal_point = {inMillionths(saved.cx - calibrated.cx), inMillionths(saved.cy - calibrated.cy)};
  const double farthest = most_principal_point_change * std::max(calibrated.width, calibrated.height);
  for (const double change : found.principal_point) {
    if (!(std::abs(change) <= farthest)) return std::nullopt;
  }
  Camera made = withFound(calibrated, found);
  const auto same = [&](double a, double b) { return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b)); };
  if (!same(made.fx, saved.fx) || !same(made.fy, saved.fy)) return std::nullopt;
  if (!same(made.cx, saved.cx) || !same(made.cy, saved.cy)) return std::nullopt;
  for (std::size_t k = 0; k < found.radial.size(); ++k) {
    if (!same(made.distortion[k], saved.distortion[k])) return std::nullopt;
    made.distortion[k] = saved.distortion[k];
  }
  made.fx = saved.fx;
  made.fy = saved.fy;
  made.cx = saved.cx;
  made.cy = saved.cy;
  return made == saved ? std::optional(found) : std::nullopt;
}

}  // namespace

void saveMap(const std::string& path, const Camera& camera, const Map& map) {
  const Camera found = withFound(camera, map.found);
  const std::string problem = mapProblem(found, map);
  if (!problem.empty()) throw std::logic_error("the map would not be read back: " + problem);
  writeFileAtomically(path, encodeMap({found, map}));
}

void requireMapCanBeSaved(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw InputError(path + ": expected a file to save the map to, this is no file");
  }
  const std::filesystem::path folder = std::filesystem::absolute(path, error).parent_path();
  if (!std::filesystem::is_directory(folder, error)) {
    throw InputError(path + ": the map cannot be saved there: " + folder.string() + " is no folder");
  }
  // Permissions alone don't tell: there are folders in which not even root can make a file.
  try {
    const PendingFile trial(path, "");
  } catch (const InputError& problem) {
    const std::string reason = std::string(problem.what()).substr(path.size() + std::string(": ").size());
    throw InputError(path + ": the map cannot be saved there: " + reason);
  }
}

SavedMap readMap(const std::string& path) {
  SavedMap saved = decodeMap(readWhole(path), path);
  if (saved.map.keyframes.empty()) throw InputError(path + ": the map has no keyframe");
  return saved;
}

Map loadMap(const std::string& path, const Camera& camera) {
  SavedMap saved = readMap(path);
  if (saved.camera == camera) return std::move(saved.map);
  if (const std::optional<FoundCamera> found = foundBeside(camera, saved.camera)) {
    saved.map.found = *found;
    return std::move(saved.map);
  }
  std::string problem = path + ": the map was made with another calibration than that of these frames";
  const double readout_s = std::exchange(saved.camera.readout_s, camera.readout_s);
  if (saved.camera == camera) {
    problem += formatted(": its readout is %.9g s, theirs is %.9g s", readout_s, camera.readout_s);
  }
  throw InputError(problem);
}

}  // namespace edgeslam
