// The run's messages as ROS 2 has them, in metres and radians (REP 103), frames by REP 105. They are made of what goes
// out over LCM, so that both tell the same.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/lcm_publisher.h"
#include "drivers/ros2/ros2_options.h"
#include "drivers/ros2/ros_covariance.h"

namespace edgeslam {

// geometry_msgs/PoseWithCovarianceStamped: frame_T_body.
struct RosPose {
  std::int64_t stamp_ns = 0;  // CLOCK_REALTIME, here and below
  std::string frame;
  Pose pose;
  RosCovariance covariance{};
};

// nav_msgs/Odometry.
struct RosOdometry {
  RosPose pose;
  std::string body_frame;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();       // along the body's axes [m/s]
  Eigen::Vector3d rotation_rate = Eigen::Vector3d::Zero();  // about them [rad/s]
  RosCovariance twist_covariance{};                         // likewise
};

// geometry_msgs/TransformStamped: parent_T_child.
struct RosTransform {
  std::int64_t stamp_ns = 0;
  std::string parent, child;
  Pose pose;
};

// What one frame gives.
struct RosFrame {
  std::optional<RosPose> pose;                          // of a measured pose alone
  std::optional<RosOdometry> odometry;                  // where the motion to the frame is known
  std::optional<RosTransform> map_T_odom, odom_T_body;  // with the odometry
  std::optional<RosTransform> map_T_body;               // where there is a pose, measured or predicted
};

// sensor_msgs/PointCloud2, of points x, y, z.
struct RosCloud {
  std::int64_t stamp_ns = 0;
  std::string frame;
  std::vector<Eigen::Vector3f> points;
};

// Where metres are not known, lengths are in map units, since ROS has no other place for them, and no position is said
// to be known: its variances are unknown_variance. Where they are known, the scale's uncertainty is in that of the pose
// in the map. A velocity that was not measured has unknown_variance, too.
RosFrame rosFrame(const SentFrame& sent, const Ros2Options& options, std::int64_t stamp_ns);

// The map's points in the frame in which the poses are.
RosCloud rosCloud(const std::vector<PublishedPoint>& points, int world, const RobotSetup& robot,
                  const Ros2Options& options, std::int64_t stamp_ns);

}  // namespace edgeslam
