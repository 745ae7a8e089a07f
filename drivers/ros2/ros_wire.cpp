#include "drivers/ros2/ros_wire.h"

namespace edgeslam {

// The library stays loaded: threads of DDS may end later than what is closed.
OpenedRosWire openRosWire(const RosWireSetup& setup, const std::vector<std::string>& folders) {
  const OpenedPlugin plugin = openPlugin("libedgeslam_ros2_dds.so", open_ros_wire_name, folders);
  if (!plugin.function) {
    return {nullptr, plugin.problem + " (Debian: the package edgeslam-ros2; a build needs cyclonedds-dev)", false};
  }
  OpenedRosWire opened;
  opened.wire.reset(reinterpret_cast<OpenRosWireFunction*>(plugin.function)(setup, opened.problem));
  opened.may_come = true;
  return opened;
}

}  // namespace edgeslam
