#include "drivers/ros2/ros_messages.h"

#include "drivers/ros2/ros_names.h"

namespace edgeslam {
namespace {

Eigen::Vector3d vectorOf(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

Eigen::Quaterniond rotationOf(const double (&wxyz)[4]) { return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]}; }

Matrix6d matrixOf(const double (&rows)[6][6]) {
  Matrix6d matrix;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) matrix(row, column) = rows[row][column];
  }
  return matrix;
}

RosPose poseInMap(const state_t& state, const Ros2Options& options, std::int64_t stamp_ns) {
  RosPose pose{stamp_ns, mapFrame(options.map_frame, state.world), {}, {}};
  pose.pose = {rotationOf(state.orientation), vectorOf(state.position)};
  const Matrix6d covariance = inParent(matrixOf(state.covariance), pose.pose.rotation);
  pose.covariance = rosCovariance(state.scale_state == state_t::SCALE_UNKNOWN
                                      ? withoutPosition(covariance)
                                      : withScaleError(covariance, pose.pose.translation, state.scale_sigma));
  return pose;
}

// Of the velocities, which are the motion over the time that it took.
Matrix6d twistCovariance(const SentFrame& sent) {
  const update_t& update = sent.frame.update;
  const double seconds = 1e-6 * static_cast<double>(update.timestamp - update.prev_timestamp);
  const bool is_measured = sent.odometry->correction.is_measured && update.estimate_status == update_t::ESTIMATE_VALID;
  if (!is_measured || !(seconds > 0)) return unknown_variance * Matrix6d::Identity();
  return matrixOf(update.covariance) / (seconds * seconds);
}

RosOdometry odometryOf(const SentFrame& sent, const Ros2Options& options, std::int64_t stamp_ns) {
  const pose_t& pose = sent.odometry->odometry;
  const bool is_metric = sent.frame.state.scale_state != state_t::SCALE_UNKNOWN;
  const auto inMetres = [&](const Matrix6d& covariance) {
    return is_metric ? covariance : withoutPosition(covariance);
  };
  RosOdometry odometry;
  odometry.body_frame = options.body_frame;
  odometry.pose = {stamp_ns, options.odom_frame, {rotationOf(pose.orientation), vectorOf(pose.pos)}, {}};
  odometry.pose.covariance =
      rosCovariance(inMetres(inParent(matrixOf(sent.odometry->correction.covariance), odometry.pose.pose.rotation)));
  odometry.velocity = vectorOf(pose.vel);
  odometry.rotation_rate = vectorOf(pose.rotation_rate);
  odometry.twist_covariance = rosCovariance(inMetres(twistCovariance(sent)));
  return odometry;
}

}  // namespace

RosFrame rosFrame(const SentFrame& sent, const Ros2Options& options, std::int64_t stamp_ns) {
  RosFrame frame;
  if (sent.frame.state.has_pose) {
    const RosPose pose = poseInMap(sent.frame.state, options, stamp_ns);
    frame.map_T_body = {stamp_ns, pose.frame, options.body_frame, pose.pose};
    if (sent.frame.pose) frame.pose = pose;
  }
  if (sent.odometry) {
    const correction_t& correction = sent.odometry->correction;
    frame.odometry = odometryOf(sent, options, stamp_ns);
    frame.map_T_odom = {stamp_ns,
                        mapFrame(options.map_frame, correction.world),
                        options.odom_frame,
                        {rotationOf(correction.rotation), vectorOf(correction.translation)}};
    frame.odom_T_body = {stamp_ns, options.odom_frame, options.body_frame, frame.odometry->pose.pose};
  }
  return frame;
}

RosCloud rosCloud(const std::vector<PublishedPoint>& points, int world, const RobotSetup& robot,
                  const Ros2Options& options, std::int64_t stamp_ns) {
  // `world` is the camera's frame where `local` is the body's.
  const Pose local_T_world = Pose{localTurnedUp(robot), Eigen::Vector3d::Zero()} * cameraOnBody(robot);
  const auto metres_per_unit = static_cast<float>(robot.scale.metres_per_unit);
  const Eigen::Matrix3f turn = local_T_world.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f place = local_T_world.translation.cast<float>();
  RosCloud cloud{stamp_ns, mapFrame(options.map_frame, world), {}};
  cloud.points.reserve(points.size());
  for (const PublishedPoint& point : points) {
    const Eigen::Vector3f in_map = turn * (metres_per_unit * point.position) + place;
    if (in_map.allFinite()) cloud.points.push_back(in_map);
  }
  return cloud;
}

}  // namespace edgeslam
