// The poses' way out: frames, status and map as LCM messages, and the robot's commands. Nothing here waits for a
// receiver or for the network: what cannot be sent, or not soon enough, is counted, and sending is tried anew.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/body_odometry.h"
#include "drivers/lcm/command_receiver.h"
#include "drivers/lcm/imu_message.h"
#include "drivers/lcm/lcm_options.h"
#include "drivers/lcm/lcm_sender.h"
#include "drivers/lcm/map_messages.h"
#include "drivers/lcm/messages.h"
#include "drivers/lcm/odometry.h"
#include "drivers/lcm/status_message.h"

namespace edgeslam {

// What of one frame went out: what is told in other ways, too, is made of it.
struct SentFrame {
  LcmFrame frame;
  std::optional<OdometryMessages> odometry;
};

// All functions are for one thread, the publishing one.
class LcmPublisher {
 public:
  // `body_T_camera`: translation [m]. Throws InputError for options that cannot be. A network that is not there is no
  // error: see problem().
  LcmPublisher(const LcmOptions& options, const Pose& body_T_camera);

  // From the next frame on.
  void setScale(const ScaleState& scale) { robot_.scale = scale; }
  // Where inertia tells it (RobotSetup::down).
  void setDown(const std::optional<Eigen::Vector3d>& down) { robot_.down = down; }
  const ScaleState& scale() const { return robot_.scale; }
  const RobotSetup& robot() const { return robot_; }

  // Each frame, in order: SLAM_STATE and SLAM_REL_ODOMETRY, SLAM_POSE where the pose was measured, SLAM_CORRECTION and
  // SLAM_ODOMETRY where the motion to it is known; some of a waiting map's parts, too.
  SentFrame frame(const FrameResult& result);

  // Each second: SLAM_STATUS; rates and latencies are over the frames since the call before.
  status_t status(const PublisherStatus& status);

  // SLAM_MAP_LINES and SLAM_MAP, their parts with the frames that follow. A map of which parts still wait is given up.
  // Versions grow.
  void map(std::int64_t version, PublishedMap map);

  // The oldest command that was not handed out yet. Those that make no sense are answered here.
  std::optional<Command> nextCommand();
  // To be called once for every command.
  void answer(const Command& command, bool accepted, const std::string& message);

  // The robot's wheel odometry, where LcmOptions name a channel for it: the oldest that was not handed out yet.
  std::optional<OdometryPose> nextOdometry();
  // Messages on its channel that were no pose of a body, or too many at once.
  std::int64_t odometryIgnored() const { return wheels_ ? wheels_->ignored() : 0; }

  // The robot's inertial unit, and its wheel odometry, where LcmOptions name a channel for it, else null; for one other
  // thread, which then has all of it.
  ImuReceiver* imu() { return imu_.get(); }
  OdometryReceiver* wheels() { return wheels_.get(); }

  // As of now; messages that wait to be sent are not counted yet.
  LcmCounts counts() const;
  // Why messages do not go out at present, in one line with what to do; empty where they do.
  std::string problem() const { return sender_.problem(); }
  // True from when commands are heard.
  bool listening() const { return receiver_ && receiver_->listener().listening(); }

 private:
  void sendMapParts();
  void rejoinAfterComeback();

  LcmOptions options_;
  RobotSetup robot_;
  LcmSender sender_;
  std::unique_ptr<CommandReceiver> receiver_;  // null where the URL cannot receive
  std::unique_ptr<OdometryReceiver> wheels_;   // likewise, and where no channel is named
  std::unique_ptr<ImuReceiver> imu_;           // likewise
  std::optional<MeasuredPose> before_;
  BodyOdometry body_odometry_;
  FrameStatistics statistics_;
  std::int64_t states_ = 0, statuses_ = 0, commands_ = 0, comebacks_ = 0;

  PublishedMap map_;
  std::int64_t map_version_ = 0, map_utime_ = 0;
  int next_part_ = 0, line_parts_ = 0, parts_ = 0;  // those of the lines, and after them those of the points
};

}  // namespace edgeslam
