#include "drivers/v4l2/device_list.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

// The number of "video12"; negative for any other name.
int videoNumber(const std::string& name) {
  if (name.rfind("video", 0) != 0 || name.size() < 6 || name.size() > 10) return -1;
  const bool digits = std::all_of(name.begin() + 5, name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return digits ? std::atoi(name.c_str() + 5) : -1;
}

// From "video0" to a link in the folder that leads to it; of several, the first by name.
std::map<std::string, std::string> linksTo(const fs::path& folder) {
  std::map<std::string, std::string> links;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string target = fs::read_symlink(entry.path(), error).filename().string();
    if (target.empty()) continue;
    std::string& link = links[target];
    if (link.empty() || entry.path().string() < link) link = entry.path().string();
  }
  return links;
}

}  // namespace

std::vector<ListedCamera> listV4l2Cameras(const std::string& folder, SystemCalls& system) {
  std::map<int, std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (const int number = videoNumber(name); number >= 0) names[number] = name;
  }
  const std::map<std::string, std::string> by_id = linksTo(fs::path(folder) / "v4l/by-id");
  const std::map<std::string, std::string> by_path = linksTo(fs::path(folder) / "v4l/by-path");

  std::vector<ListedCamera> cameras;
  for (const auto& [number, name] : names) {
    ListedCamera camera;
    camera.path = folder + "/" + name;
    if (const auto link = by_id.find(name); link != by_id.end()) camera.by_id = link->second;
    if (const auto link = by_path.find(name); link != by_path.end()) camera.by_path = link->second;
    const OpenedDevice opened = openCaptureDevice(system, camera.path);
    if (opened.device) {
      camera.card = opened.device->card;
      camera.driver = opened.device->driver;
      camera.bus = opened.device->bus;
      camera.formats = offeredFormats(*opened.device);
      camera.controls = cameraControls(*opened.device);
      camera.sensor = sensorRows(*opened.device, presentSize(*opened.device));
    } else if (opened.is_other_device) {
      continue;
    } else {
      camera.problem = opened.problem.text;
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace edgeslam
