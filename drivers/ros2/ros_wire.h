// The way out to ROS 2: messages over DDS. What is behind it is a library of its own, loaded where ROS 2 is wanted, so
// that a robot without it needs no DDS (folder dds/).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/ros2/ros_diagnostics.h"
#include "drivers/ros2/ros_messages.h"
#include "plugins/plugin.h"

namespace edgeslam {

struct RosWireSetup {
  int domain = 0;
  std::string topic_namespace;
  bool hears_transforms = false;  // of others
};

// For one thread. Nothing waits for a subscriber.
class RosWire {
 public:
  virtual ~RosWire() = default;

  // False where it was left out: subscribers have not taken in what went out before, or DDS refuses it.
  virtual bool send(const RosPose& pose) = 0;
  virtual bool send(const RosOdometry& odometry) = 0;
  virtual bool send(const std::vector<RosTransform>& transforms) = 0;
  virtual bool send(const RosCloud& cloud) = 0;
  virtual bool send(const RosDiagnostics& diagnostics) = 0;

  // Those of others that came since.
  virtual void takeTransforms(const std::function<void(const RosTransform&)>& take) = 0;
  // Our topics that another program publishes, too; each is told once.
  virtual std::vector<std::string> rivals() = 0;
  // What DDS complained of since the call before, one line; or empty.
  virtual std::string complaint() = 0;
};

struct OpenedRosWire {
  std::unique_ptr<RosWire> wire;  // null where it cannot be opened
  std::string problem;            // then, in one line
  bool may_come = false;          // then: by itself, as with a network that is not up yet
};

OpenedRosWire openRosWire(const RosWireSetup& setup, const std::vector<std::string>& folders = pluginFolders());

// What the library gives: `problem` where it returns null.
extern "C" using OpenRosWireFunction = RosWire * (const RosWireSetup& setup, std::string& problem);
constexpr const char* open_ros_wire_name = "edgeslamOpenRosWire";

}  // namespace edgeslam
