#include "drivers/lcm/lcm_publisher.h"

#include <chrono>

#include "drivers/lcm/clocks.h"

namespace edgeslam {
namespace {

// A whole map at once would push poses out of receivers' buffers, which hold some 150 packets by default, and would
// fill a wireless link: these are 1.3 Mbit/s at 30 frames/s.
constexpr int map_parts_at_once = 4;

LcmOptions checked(LcmOptions options) {
  checkChannels(options);
  options.url = effectiveUrl(options);
  return options;
}

}  // namespace

LcmPublisher::LcmPublisher(const LcmOptions& options, const Pose& body_T_camera)
    : options_(checked(options)), sender_(options_.url, options_.real_time_priority) {
  robot_.body_T_camera = body_T_camera;
  if (canReceive(options_.url)) {
    receiver_ = std::make_unique<CommandReceiver>(options_.url, options_.command_channel);
    if (!options_.wheels_channel.empty()) {
      wheels_ = std::make_unique<OdometryReceiver>(options_.url, options_.wheels_channel, "odometry", checkOdometry);
    }
    if (!options_.imu_channel.empty())
      imu_ = std::make_unique<ImuReceiver>(options_.url, options_.imu_channel, "imu", checkImu);
  }
}

SentFrame LcmPublisher::frame(const FrameResult& result) {
  SentFrame sent{frameMessages(result, robot_, before_, states_++, realUtime()), body_odometry_.next(result, robot_)};
  const LcmFrame& messages = sent.frame;
  sender_.send(options_.state_channel, messages.state);  // first: it tells the world that the pose is in
  if (messages.pose) sender_.send(options_.pose_channel, *messages.pose);
  sender_.send(options_.odometry_channel, messages.update);
  if (sent.odometry) {
    sender_.send(options_.correction_channel, sent.odometry->correction);  // first: it tells of resets
    sender_.send(options_.odom_channel, sent.odometry->odometry);
  }
  if (result.state == TrackingState::initialising) before_.reset();  // the next pose is in another map
  if (const std::optional<MeasuredPose> measured = measuredPose(result)) before_ = measured;
  statistics_.add(result);
  sendMapParts();
  rejoinAfterComeback();
  return sent;
}

status_t LcmPublisher::status(const PublisherStatus& status) {
  const std::int64_t now_ns = std::chrono::steady_clock::now().time_since_epoch().count();
  status_t message =
      statusMessage(status, statistics_.take(now_ns), counts(), systemFigures(), statuses_++, monotonicUtime());
  sender_.send(options_.status_channel, message);
  sendMapParts();
  rejoinAfterComeback();
  return message;
}

void LcmPublisher::map(std::int64_t version, PublishedMap map) {
  map_ = finiteMap(std::move(map));
  map_version_ = version;
  map_utime_ = monotonicUtime();
  next_part_ = 0;
  line_parts_ = numberOfLineParts(map_.lines.size());
  parts_ = line_parts_ + numberOfPointParts(map_.points.size());
}

std::optional<Command> LcmPublisher::nextCommand() {
  while (receiver_) {
    std::optional<CheckedCommand> checked_command = receiver_->next();
    if (!checked_command) break;
    if (checked_command->refusal) {
      sender_.send(options_.answer_channel, *checked_command->refusal);
      continue;
    }
    ++commands_;
    return checked_command->command;
  }
  return std::nullopt;
}

void LcmPublisher::answer(const Command& command, bool accepted, const std::string& message) {
  sender_.send(options_.answer_channel, commandAnswer(command, accepted, message, monotonicUtime()));
}

std::optional<OdometryPose> LcmPublisher::nextOdometry() { return wheels_ ? wheels_->next() : std::nullopt; }

LcmCounts LcmPublisher::counts() const {
  return {sender_.sent(), sender_.notSent(), commands_, receiver_ ? receiver_->ignored() : 0};
}

// Lines first: they are few, and are not kept waiting by a large map's points.
void LcmPublisher::sendMapParts() {
  for (int i = 0; i < map_parts_at_once && next_part_ < parts_; ++i, ++next_part_) {
    if (next_part_ < line_parts_) {
      sender_.send(options_.map_lines_channel, linePart(map_.lines, next_part_, map_version_, map_utime_, robot_));
    } else {
      sender_.send(options_.map_channel,
                   pointPart(map_.points, next_part_ - line_parts_, map_version_, map_utime_, robot_));
    }
  }
}

void LcmPublisher::rejoinAfterComeback() {
  if (sender_.comebacks() == comebacks_) return;
  comebacks_ = sender_.comebacks();
  if (receiver_) receiver_->listener().joinAnew();
  if (wheels_) wheels_->listener().joinAnew();
  if (imu_) imu_->listener().joinAnew();
}

}  // namespace edgeslam
