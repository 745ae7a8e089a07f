// Metres and upright by the real program, from what an inertial unit says over LCM.
#include <gtest/gtest.h>

#include <cmath>

#include "edgeslam/imu_t.hpp"
#include "edgeslam/ins_t.hpp"
#include "frames/inertial_file.h"
#include "system/daemon/beside_frames.h"
#include "system/daemon/daemon_fixture.h"
#include "system/program.h"

namespace edgeslam {
namespace {

// By both types in turn, in bursts, and among messages that are nothing of a unit's.
void publish(lcm::LCM& lcm, const InertialSample& sample, std::size_t index) {
  if (index % 2 == 1) {
    ins_t published{};
    published.utime = sample.time_ns / 1000;
    std::copy_n(sample.rate.data(), 3, published.gyro);
    std::copy_n(sample.force.data(), 3, published.accel);
    lcm.publish("IMU", &published);
    return;
  }
  imu_t message{};
  message.utime = sample.time_ns / 1000;
  std::copy_n(sample.rate.data(), 3, message.rotation_rate);
  std::copy_n(sample.force.data(), 3, message.specific_force);
  lcm.publish("IMU", &message);
  if (index % 40 != 0) return;
  lcm.publish("IMU", &message);  // repeated
  message.utime -= 300'000;
  lcm.publish("IMU", &message);  // late
  message.specific_force[1] = NAN;
  lcm.publish("IMU", &message);
  lcm.publish("IMU", "nothing", 7);
}

class DaemonInertia : public DaemonTest {
 protected:
  static constexpr int frames = 300;
  const std::string way_ = std::string(EDGESLAM_RUN_FOLDER) + "/felt";
  const std::string used_ = "imu: {enabled: true, calibration: " + way_ + "/imu.yaml}\n";
};

TEST_F(DaemonInertia, GivesMetresAndUpright) {
  const std::string configuration = configure(used_);
  const auto daemon = startOn(way_, {"--config", configuration, "--record", folder_.path("recording")});
  const BesideFrames<InertialSample> unit(*robot_, readInertialSamples(way_ + "/imu.csv"), publish);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.frames_captured >= frames; }));
  std::vector<state_t> metric;
  for (const state_t& state : robot_->heard().states) {
    if (state.scale_state == state_t::SCALE_FROM_INERTIA) metric.push_back(state);
  }
  ASSERT_GT(metric.size(), 30U) << daemon->said();
  const Trajectory truth = readTrajectory(way_ + "/groundtruth.txt");
  const AbsoluteError error = absoluteError(trajectoryOf(metric), truth, Alignment::similarity);
  EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.05);
  EXPECT_LT(error.translation.rmse, 0.02);
  const Eigen::Vector3d up = error.reference_T_estimate.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(up.z()), 0.03) << "the world's z is not up";
  EXPECT_EQ(daemon->times("metres a map unit"), 1) << "told once: " << daemon->said();

  const Outcome repeated =
      runProgram({"replay", folder_.path("recording"), "--output", folder_.path("repeated"), "--drawings", "0"});
  EXPECT_EQ(repeated.exit_code, 0) << repeated.messages;
  EXPECT_NE(repeated.output.find("lengths are metres"), std::string::npos) << repeated.output;
}

TEST_F(DaemonInertia, ThatDoesNotComeIsToldAndTheCameraGoesOnAlone) {
  const auto daemon = startOn(way_, {"--config", configure(used_)});
  EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) {
    return status.scale_reason.find("nothing has come from it") != std::string::npos;
  })) << daemon->said();
  EXPECT_TRUE(isTracking());
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_EQ(daemon->times("nothing has come from it"), 1) << "told once: " << daemon->said();
}

TEST_F(DaemonInertia, OfWhichItIsNotKnownWhereItSitsIsRefused) {
  const auto daemon = startOn(way_, {"--config", configure("imu: {enabled: true}\n")});
  EXPECT_EQ(daemon->exitCode(), 2);
  EXPECT_TRUE(daemon->says("imu.imu_T_camera")) << daemon->said();
}

}  // namespace
}  // namespace edgeslam
