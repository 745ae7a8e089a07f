// Configurations, with the file they include (base.yaml) and the calibration they name (camera.yaml), all three parted
// by lines "====": a configuration that reads back the same after it was written, or messages.
#include "configuration/configuration.h"
#include "configuration/configuration_text.h"
#include "fuzz_input.h"
#include "map/map_check.h"

namespace {

using namespace edgeslam;

// Every file named is of the folder or has a path of its own.
void requireRefused(const std::string& path, const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) requireMessage(problem, "/");
  bool refused = false;
  try {
    readConfiguration(path);
  } catch (const InputError& error) {
    refused = true;
    requireMessage(error.what(), problems.front());
  }
  require(refused, "what has problems is refused");
}

void requireReadBack(const Configuration& configuration, const MemoryFolder& folder) {
  const std::string text = formatConfiguration(configuration);
  std::vector<std::string> problems;
  const Configuration again = readConfiguration(folder.write("written.yaml", text), problems);
  require(problems.empty(),
          "a written configuration is read back: " + (problems.empty() ? "" : problems.front()) + text);
  require(formatConfiguration(again) == text, "a written configuration is read back the same: " + text);
  require(again.camera == configuration.camera, "the camera is read back to the last bit");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFolder folder;
  const auto files = splitFiles(data, size, 3);
  const std::string path = folder.write("edgeslam.yaml", files[0]);
  folder.write("base.yaml", files[1]);
  folder.write("camera.yaml", files[2]);
  std::vector<std::string> problems;
  const Configuration configuration = readConfiguration(path, problems);
  if (!problems.empty()) {
    requireRefused(path, problems);
    return 0;
  }
  const Pose& pose = configuration.body_T_camera;
  require(pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-6, "the camera's place is a pose");
  if (configuration.camera) require(cameraProblem(*configuration.camera).empty(), "maps of the camera can be saved");
  requireReadBack(configuration, folder);
  isCalibrationFile(path);
  return 0;
}
