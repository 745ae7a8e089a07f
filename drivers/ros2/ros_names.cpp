#include "drivers/ros2/ros_names.h"

namespace edgeslam {

std::string rosTopic(const std::string& topic_namespace, const std::string& name) {
  return (topic_namespace.empty() ? "/" : "/" + topic_namespace + "/") + name;
}

std::string ddsTopic(const std::string& ros_topic) { return "rt" + ros_topic; }

std::string mapFrame(const std::string& map_frame, int world) {
  return world <= 0 ? map_frame : map_frame + "_" + std::to_string(world);
}

}  // namespace edgeslam
