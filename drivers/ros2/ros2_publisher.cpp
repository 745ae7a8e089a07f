#include "drivers/ros2/ros2_publisher.h"

#include "drivers/lcm/clocks.h"
#include "drivers/ros2/ros_names.h"

namespace edgeslam {

Ros2Publisher::Ros2Publisher(const Ros2Options& options, int real_time_priority)
    : options_(options), sender_(options, real_time_priority) {}

void Ros2Publisher::frame(const SentFrame& sent) {
  const std::int64_t stamp_ns = clock_.stamp_ns(sent.frame.state.utime, realUtime(), monotonicUtime());
  sender_.send(rosFrame(sent, options_, stamp_ns));
}

void Ros2Publisher::status(const status_t& status, const ScaleState& scale) {
  const std::string& prefix = options_.topic_namespace;
  const std::string node = prefix.empty() ? "edgeslam" : prefix + "/edgeslam";
  sender_.send(rosDiagnostics(status, scale, node, 1000 * realUtime()));
}

void Ros2Publisher::map(const PublishedMap& map, int world, const RobotSetup& robot) {
  sender_.send(rosCloud(map.points, world, robot, options_, 1000 * realUtime()));
}

}  // namespace edgeslam
