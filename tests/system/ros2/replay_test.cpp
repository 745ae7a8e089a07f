// A whole run, to ROS 2 and over LCM: both tell the same.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "system/daemon/robot.h"
#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"
#include "system/ros2/fast_dds.h"

namespace edgeslam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

Eigen::Vector3d vectorOf(const double* values) { return Eigen::Map<const Eigen::Vector3d>(values); }
Eigen::Quaterniond fromLcm(const double* wxyz) { return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]}; }
Eigen::Quaterniond fromRos(const std::array<double, 4>& xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

void expectSamePose(const std::array<double, 3>& position, const std::array<double, 4>& orientation,
                    const double* lcm_position, const double* lcm_orientation) {
  EXPECT_NEAR((vectorOf(position.data()) - vectorOf(lcm_position)).norm(), 0, 1e-12);
  EXPECT_NEAR(fromRos(orientation).angularDistance(fromLcm(lcm_orientation)), 0, 1e-7);
}

// The rotations of ROS's are about the parent's axes, and nothing is known of a position in metres: no scale is known.
void expectSameRotationCovariance(const std::array<double, 36>& ros, const double (&lcm)[6][6],
                                  const Eigen::Quaterniond& orientation) {
  const Eigen::Matrix3d of_body = Eigen::Map<const Matrix6>(&lcm[0][0]).bottomRightCorner<3, 3>();
  const Eigen::Matrix3d turn = orientation.toRotationMatrix();
  const Matrix6 told = Eigen::Map<const Matrix6>(ros.data());
  EXPECT_TRUE((told.bottomRightCorner<3, 3>()).isApprox(turn * of_body * turn.transpose(), 1e-9));
  EXPECT_EQ((told.topLeftCorner<3, 3>()), 1e6 * Eigen::Matrix3d::Identity());
}

template <typename Message>
std::map<std::int64_t, Message> byUtime(const std::vector<Message>& messages) {
  std::map<std::int64_t, Message> found;
  for (const Message& message : messages) found[message.utime] = message;
  return found;
}

std::vector<Eigen::Vector3f> pointsOf(const decoded::Cloud& cloud) {
  std::vector<Eigen::Vector3f> points(cloud.width);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(points[i].data(), cloud.data.data() + i * cloud.point_step, 12);
  }
  return points;
}

class Ros2Replay : public OwnNetwork {
 protected:
  std::string configuration(const std::string& ros2) const {
    const std::string path = folder_.path("robot.yaml");
    std::ofstream(path) << "camera: {body_T_camera: {translation: [0.1, 0, 0.3], quaternion: [0.5, -0.5, 0.5, -0.5]}}\n"
                        << "lcm: {map_interval_s: 1}\nros2: " << ros2 << "\n";
    return path;
  }
  BackgroundProcess replay(const std::string& ros2) const {
    return BackgroundProcess({EDGESLAM_PROGRAM, "replay", EDGESLAM_ROS2_DRIVE, "--realtime", "--lcm", "--config",
                              configuration(ros2), "--output", folder_.path("run")});
  }
  TemporaryFolder folder_;
};

TEST_F(Ros2Replay, TellsWhatLcmTells) {
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Odometry> odometry(participant, "rt/odom");
  const FastDdsReader<decoded::Pose> poses(participant, "rt/pose");
  const FastDdsReader<decoded::Transforms> transforms(participant, "rt/tf");
  const FastDdsReader<decoded::Cloud> clouds(participant, "rt/map_points", {true, 10});
  const FastDdsReader<decoded::Diagnostics> diagnostics(participant, "rt/diagnostics");
  const Robot robot;
  BackgroundProcess run = replay("{enabled: true}");
  ASSERT_EQ(run.exitCode(), 0) << run.said();
  EXPECT_EQ(run.times("ROS 2: messages go out on domain 0"), 1) << run.said();
  EXPECT_EQ(run.times("ROS 2: DDS says: selected interface \"lo\" is not multicast-capable"), 1) << run.said();
  EXPECT_EQ(run.times("ROS 2:"), 2) << run.said();
  const Heard heard = robot.heard();

  // One difference of the clocks for all: the recording's times go on from now.
  ASSERT_GT(odometry.count(), 100U);
  std::map<std::int64_t, std::int64_t> differences;
  const std::map<std::int64_t, pose_t> lcm_odometry = byUtime(heard.odometry);
  for (const decoded::Odometry& ros : odometry.heard()) {
    for (const auto& [utime, lcm] : lcm_odometry) {
      if (std::equal(ros.position.begin(), ros.position.end(), lcm.pos))
        ++differences[ros.header.stamp_ns() - 1000 * utime];
    }
  }
  std::int64_t difference_ns = 0, most = 0;
  for (const auto& [difference, count] : differences) {
    if (count > most) difference_ns = difference, most = count;
  }
  const auto utimeOf = [&](const decoded::Header& header) { return (header.stamp_ns() - difference_ns) / 1000; };

  const std::map<std::int64_t, state_t> states = byUtime(heard.states);
  const std::map<std::int64_t, correction_t> corrections = byUtime(heard.corrections);
  for (const decoded::Odometry& ros : odometry.heard()) {
    const auto lcm = lcm_odometry.find(utimeOf(ros.header));
    ASSERT_NE(lcm, lcm_odometry.end());
    expectSamePose(ros.position, ros.orientation, lcm->second.pos, lcm->second.orientation);
    expectSameRotationCovariance(ros.covariance, corrections.at(lcm->first).covariance, fromRos(ros.orientation));
    EXPECT_EQ(vectorOf(ros.linear.data()), vectorOf(lcm->second.vel));
    EXPECT_EQ(vectorOf(ros.angular.data()), vectorOf(lcm->second.rotation_rate));
    EXPECT_EQ(ros.header.frame_id + ros.child_frame_id, "odombase_link");
  }
  ASSERT_GT(poses.count(), 100U);
  for (const decoded::Pose& ros : poses.heard()) {
    const state_t& lcm = states.at(utimeOf(ros.header));
    expectSamePose(ros.position, ros.orientation, lcm.position, lcm.orientation);
    expectSameRotationCovariance(ros.covariance, lcm.covariance, fromRos(ros.orientation));
    EXPECT_EQ(ros.header.frame_id, "map");
  }
  ASSERT_EQ(transforms.count(), odometry.count());
  for (const decoded::Transforms& ros : transforms.heard()) {
    ASSERT_EQ(ros.transforms.size(), 2U);
    const decoded::Transform &first = ros.transforms[0], &second = ros.transforms[1];
    EXPECT_EQ(first.header.frame_id + first.child_frame_id, "mapodom");
    EXPECT_EQ(second.header.frame_id + second.child_frame_id, "odombase_link");
    const std::int64_t utime = utimeOf(second.header);
    EXPECT_EQ(utimeOf(first.header), utime);
    const correction_t& correction = corrections.at(utime);
    expectSamePose(first.translation, first.rotation, correction.translation, correction.rotation);
    expectSamePose(second.translation, second.rotation, lcm_odometry.at(utime).pos, lcm_odometry.at(utime).orientation);
  }

  // Each map is that of SLAM_MAP, seen from the body: one of them has the very same points.
  ASSERT_GT(clouds.count(), 0U);
  const Eigen::Matrix3f turn = Eigen::Quaternionf(0.5F, -0.5F, 0.5F, -0.5F).toRotationMatrix();
  std::map<std::int64_t, std::vector<Eigen::Vector3f>> maps;
  std::map<std::int64_t, int> parts_to_come;
  for (const map_part_t& part : heard.map_parts) {
    parts_to_come.emplace(part.version, part.parts).first->second -= 1;
    for (int i = 0; i < part.points; ++i) {
      maps[part.version].push_back(turn * Eigen::Map<const Eigen::Vector3f>(part.position[i]));
    }
  }
  int same = 0;
  for (const decoded::Cloud& cloud : clouds.heard()) {
    EXPECT_EQ(cloud.header.frame_id, "map");
    EXPECT_EQ(cloud.height, 1U);
    EXPECT_EQ(cloud.point_step, 12U);
    EXPECT_EQ(cloud.row_step, cloud.data.size());
    EXPECT_FALSE(cloud.is_bigendian);
    EXPECT_TRUE(cloud.is_dense);
    ASSERT_EQ(cloud.fields.size(), 3U);
    EXPECT_EQ(cloud.fields[2].name, "z");
    EXPECT_EQ(cloud.fields[2].offset, 8U);
    EXPECT_EQ(cloud.fields[2].datatype, 7);
    EXPECT_EQ(cloud.fields[2].count, 1U);
    for (const auto& [version, points] : maps) {
      if (parts_to_come[version] != 0 || points.size() != cloud.width) continue;
      const std::vector<Eigen::Vector3f> told = pointsOf(cloud);
      float farthest = 0;
      for (std::size_t i = 0; i < told.size(); ++i) farthest = std::max(farthest, (told[i] - points[i]).norm());
      if (farthest < 1e-4F) ++same;
    }
  }
  EXPECT_GT(same, 0);

  ASSERT_GT(diagnostics.count(), 3U);
  const decoded::Diagnostics last = diagnostics.heard().back();
  ASSERT_EQ(last.status.size(), 2U);
  EXPECT_EQ(last.status[0].name, "edgeslam: pose");
  EXPECT_EQ(last.status[0].hardware_id, "edgeslam");
  EXPECT_EQ(last.status[0].level, 0) << last.status[0].message;
  EXPECT_EQ(last.status[1].level, 1) << "the scale is not known";
  for (const int wrong :
       {odometry.wrong(), poses.wrong(), transforms.wrong(), clouds.wrong(), diagnostics.wrong(), odometry.mismatches(),
        poses.mismatches(), transforms.mismatches(), clouds.mismatches(), diagnostics.mismatches()}) {
    EXPECT_EQ(wrong, 0);
  }
}

TEST_F(Ros2Replay, IsSilentWhereItIsNotWanted) {
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Odometry> odometry(participant, "rt/odom");
  const Robot robot;
  BackgroundProcess run = replay("{domain: 0}");
  EXPECT_TRUE(robot.hears([](const Heard& heard) { return heard.odometry.size() > 30; }));
  EXPECT_EQ(fileContent("/proc/" + std::to_string(run.id()) + "/maps").find("libddsc"), std::string::npos)
      << "nor is DDS loaded";
  run.end(SIGTERM);
  EXPECT_EQ(odometry.publishers(), 0);
  EXPECT_EQ(run.times("ROS 2"), 0) << run.said();
}

// As where its package is not installed.
TEST_F(Ros2Replay, PosesGoOnWhereDdsIsNotThere) {
  const std::string program = folder_.path("edgeslam");
  std::filesystem::copy_file(EDGESLAM_PROGRAM, program);
  const Robot robot;
  BackgroundProcess run({program, "replay", EDGESLAM_ROS2_DRIVE, "--realtime", "--lcm", "--config",
                         configuration("{enabled: true}"), "--output", folder_.path("run")});
  EXPECT_EQ(run.exitCode(), 0) << run.said();
  EXPECT_GT(robot.heard().odometry.size(), 100U);
  EXPECT_EQ(run.times("ROS 2: left out: libedgeslam_ros2_dds.so is not there"), 1) << run.said();
  EXPECT_EQ(run.times("ROS 2"), 1) << run.said();
}

}  // namespace
}  // namespace edgeslam
