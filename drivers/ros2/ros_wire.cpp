#include "drivers/ros2/ros_wire.h"

#include <dlfcn.h>

#include <filesystem>

namespace edgeslam {
namespace {

constexpr const char* library = "libedgeslam_ros2_dds.so";

// By its whole path: the search path of the system's libraries does not count.
std::string pathOfLibrary(const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / library;
    std::error_code error;
    if (std::filesystem::exists(path, error)) return path.string();
  }
  return "";
}

}  // namespace

std::vector<std::string> rosWireFolders() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path folder = program.parent_path();
  return {folder.string(), (folder / EDGESLAM_WAY_TO_LIBRARIES).lexically_normal().string()};
}

// The library stays loaded: threads of DDS may end later than what is closed.
OpenedRosWire openRosWire(const RosWireSetup& setup, const std::vector<std::string>& folders) {
  const std::string advice = " (Debian: the package edgeslam-ros2; a build needs cyclonedds-dev)";
  const std::string path = pathOfLibrary(folders);
  if (path.empty()) return {nullptr, std::string(library) + " is not there" + advice, false};
  void* loaded = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = loaded ? dlsym(loaded, open_ros_wire_name) : nullptr;
  if (!function) {
    const char* why = dlerror();
    return {nullptr, (why ? why : path) + advice, false};
  }
  OpenedRosWire opened;
  opened.wire.reset(reinterpret_cast<OpenRosWireFunction*>(function)(setup, opened.problem));
  opened.may_come = true;
  return opened;
}

}  // namespace edgeslam
