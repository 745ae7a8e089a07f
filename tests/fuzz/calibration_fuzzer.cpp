// Calibration files of all kinds: a camera that all later stages can work with, also after it was written into a
// recording and read again, or one message.
#include <algorithm>
#include <cmath>

#include "edgeslam/input_error.h"
#include "frames/calibration_file.h"
#include "fuzz_input.h"
#include "map/map_check.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgeslam;
  static const MemoryFolder folder;
  const std::string path = folder.write("camera.yaml", {reinterpret_cast<const char*>(data), size});
  try {
    const Camera camera = readCalibration(path);
    require(cameraProblem(camera).empty(), "a map of this camera can be saved: " + cameraProblem(camera));
    require(camera.cx >= 0 && camera.cx <= camera.width - 1, "the centre lies in the image");
    require(camera.cy >= 0 && camera.cy <= camera.height - 1, "the centre lies in the image");
    const std::string written = folder.write("written.yaml", formatCalibrationFile(camera));
    require(readCalibration(written) == camera, "a written calibration is read back to the last bit");
  } catch (const InputError& error) {
    requireMessage(error.what(), path);
  }
  return 0;
}
