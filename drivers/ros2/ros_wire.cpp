#include "drivers/ros2/ros_wire.h"

#include <dlfcn.h>

namespace edgeslam {
namespace {

// Found beside the program, or where the package puts it: by the program's own search path (RUNPATH).
constexpr const char* library = "libedgeslam_ros2_dds.so";

}  // namespace

// Stays loaded: threads of DDS may end later than what is closed.
OpenedRosWire openRosWire(const RosWireSetup& setup) {
  void* loaded = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  void* function = loaded ? dlsym(loaded, open_ros_wire_name) : nullptr;
  if (!function) {
    const char* why = dlerror();
    return {nullptr,
            std::string(why ? why : library) + " (Debian: the package edgeslam-ros2; a build needs cyclonedds-dev)",
            false};
  }
  OpenedRosWire opened;
  opened.wire.reset(reinterpret_cast<OpenRosWireFunction*>(function)(setup, opened.problem));
  opened.may_come = true;
  return opened;
}

}  // namespace edgeslam
