// The poses' way to ROS 2: what goes out over LCM, as ROS 2 expects it. Topics, types and quality of service are in
// docs/ros2.md.
#pragma once

#include "drivers/ros2/ros2_sender.h"
#include "drivers/ros2/ros_clock.h"

namespace edgeslam {

// All functions are for one thread, the publishing one. None waits.
class Ros2Publisher {
 public:
  // `options` without a ros2Problem(). DDS that is not there is no error: nextEvent() tells of it.
  Ros2Publisher(const Ros2Options& options, int real_time_priority);

  // What LcmPublisher sent: of each frame, each second, and of each map. `world`: that the map is of.
  void frame(const SentFrame& sent);
  void status(const status_t& status, const ScaleState& scale);
  void map(const PublishedMap& map, int world, const RobotSetup& robot);

  // For the log, the oldest that was not handed out yet.
  std::optional<std::string> nextEvent() { return sender_.nextEvent(); }

 private:
  const Ros2Options options_;
  RosClock clock_;
  Ros2Sender sender_;
};

}  // namespace edgeslam
