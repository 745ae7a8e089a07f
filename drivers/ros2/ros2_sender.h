// Sends messages to ROS 2 from a thread of its own, so that who hands them over never waits for DDS; goes on when the
// network does not.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <variant>

#include "drivers/lcm/lcm_sender.h"
#include "drivers/ros2/heard_odometry.h"
#include "drivers/ros2/ros_wire.h"
#include "pipeline/channel.h"

namespace edgeslam {

using RosMessage = std::variant<RosFrame, RosCloud, RosDiagnostics>;

class Ros2Sender {
 public:
  // `real_time_priority` of the thread: SCHED_FIFO, 1 to 99, where it is allowed; 0: the usual scheduling.
  Ros2Sender(const Ros2Options& options, int real_time_priority);
  // Sends what waits; what ROS 2 has then is on its way for 0.2 s at most.
  ~Ros2Sender();
  Ros2Sender(const Ros2Sender&) = delete;
  Ros2Sender& operator=(const Ros2Sender&) = delete;

  // For one thread. Left out where too many wait.
  void send(RosMessage message);

  // The oldest line for the log that was not handed out yet: that messages go out, why they do not, and what is odd.
  std::optional<std::string> nextEvent();

 private:
  struct Waiting {
    RosMessage message;
    BackOff::Clock::time_point handed_over;
  };

  void run();
  void wait();
  void openWhenDue();
  void lookRound();
  void deliver(const Waiting& waiting);
  void sendFrame(const RosFrame& frame);
  void sendMapToOdom();
  void expect(bool sent, const std::string& what);
  void tellOnce(const std::string& line);

  const Ros2Options options_;
  const int real_time_priority_;
  Channel<Waiting> waiting_;
  sem_t handed_over_;
  std::atomic<bool> stopping_{false}, given_up_{false}, overflowed_{false};
  std::mutex events_mutex_;
  std::deque<std::string> events_;

  std::unique_ptr<RosWire> wire_;  // these are the thread's; null: not open
  BackOff back_off_;
  BackOff::Clock::time_point next_look_{};
  HeardOdometry heard_;
  std::deque<RosTransform> not_heard_yet_;  // map_T_body of frames for which the other node's odom_T_body is waited for
  std::set<std::string> told_;
  std::thread thread_;
};

}  // namespace edgeslam
