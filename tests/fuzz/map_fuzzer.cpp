// Saved maps: a map that keeps all its rules and is the same after it was saved and loaded, or one message. The first
// byte chooses: a whole file as it stands, or the payload, to which header and checksum are made, so that the fuzzer
// need not guess a checksum.
#include <zlib.h>

#include "edgeslam/input_error.h"
#include "fuzz_input.h"
#include "map/map_check.h"
#include "map/saved_map.h"

namespace {

using namespace edgeslam;

void appendNumber(std::string& bytes, std::uint64_t value, int width) {
  for (int i = 0; i < width; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xFF));
}

std::string wrapped(std::string_view payload) {
  std::string file("EDGESLAM MAP\r\n\x1a\n", 16);
  appendNumber(file, map_format_version, 4);
  appendNumber(file, payload.size(), 8);
  file += payload;
  const auto checksum = crc32_z(0, reinterpret_cast<const Bytef*>(file.data()), file.size());
  appendNumber(file, checksum, 4);
  return file;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const MemoryFolder folder;
  const std::string_view content(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string bytes = data[0] % 2 == 0 ? std::string(content) : wrapped(content);
  const std::string path = folder.path() + "/robot.map";
  try {
    const SavedMap saved = decodeMap(bytes, path);
    require(mapProblem(saved.camera, saved.map).empty(), "a map that was read keeps the rules");
    const std::string again = encodeMap(saved);
    require(encodeMap(decodeMap(again, path)) == again, "a saved map is read back the same");
    if (data[0] % 2 != 0) return 0;
    folder.write("robot.map", bytes);
    const Map loaded = loadMap(path, saved.camera);
    require(encodeMap({saved.camera, loaded}) == again, "the file gives the same map as its bytes");
  } catch (const InputError& error) {
    requireMessage(error.what(), path);
  }
  return 0;
}
