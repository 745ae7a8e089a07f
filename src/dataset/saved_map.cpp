#include "dataset/saved_map.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "dataset/atomic_file.h"
#include "edgeslam/input_error.h"
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
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file || !file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError(path + ": cannot be read");
  return bytes;
}

}  // namespace

void saveMap(const std::string& path, const Camera& camera, const Map& map) {
  const std::string problem = mapProblem(camera, map);
  if (!problem.empty()) throw std::logic_error("the map would not be read back: " + problem);
  writeFileAtomically(path, encodeMap({camera, map}));
}

Map loadMap(const std::string& path, const Camera& camera) {
  SavedMap saved = decodeMap(readWhole(path), path);
  if (saved.map.keyframes.empty()) throw InputError(path + ": the map has no keyframe");
  if (!(saved.camera == camera)) {
    throw InputError(path + ": the map was made with another calibration than that of these frames");
  }
  return std::move(saved.map);
}

}  // namespace edgeslam
