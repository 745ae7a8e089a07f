// Metres by the real program, and poses while a hand is on the lens, from what the wheels say over LCM.
#include <gtest/gtest.h>

#include <cmath>

#include "edgeslam/pose_t.hpp"
#include "frames/wheel_file.h"
#include "system/daemon/beside_frames.h"
#include "system/daemon/daemon_fixture.h"
#include "system/program.h"

namespace edgeslam {
namespace {

// In bursts, and among messages that are no pose of a body.
void publishWheels(lcm::LCM& lcm, const OdometryPose& pose, std::size_t index) {
  pose_t message{};
  message.utime = pose.utime;
  std::copy_n(pose.local_T_body.translation.data(), 3, message.pos);
  const Eigen::Quaterniond& q = pose.local_T_body.rotation;
  const double orientation[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(orientation, 4, message.orientation);
  lcm.publish("WHEELS", &message);
  if (index % 10 != 0) return;
  lcm.publish("WHEELS", &message);  // repeated
  message.utime -= 300'000;
  lcm.publish("WHEELS", &message);  // late
  message.pos[1] = NAN;
  lcm.publish("WHEELS", &message);
  lcm.publish("WHEELS", "nothing", 7);
}

class DaemonWheels : public DaemonTest {
 protected:
  static constexpr int frames = 300, covered_from = 200, covered_to = 219;
  const std::string way_ = std::string(EDGESLAM_RUN_FOLDER) + "/driven";
  const std::string used_ = "wheels: {enabled: true}\nscale: {source: odometry, odometry_channel: WHEELS}\n";
};

TEST_F(DaemonWheels, GiveMetresAndPosesWhileTheLensIsCovered) {
  const auto daemon = startOn(way_, {"--config", configure(used_), "--record", folder_.path("recording")});
  const BesideFrames<OdometryPose> wheels(*robot_, readWheelOdometry(way_ + "/wheel_odometry.txt"), publishWheels);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.frames_captured >= frames; }));
  std::vector<state_t> metric;
  int covered = 0, covered_and_good = 0;
  for (const state_t& state : robot_->heard().states) {
    if (state.scale_state == state_t::SCALE_FROM_ODOMETRY) metric.push_back(state);
    if (state.frame < covered_from || state.frame > covered_to) continue;
    ++covered;
    covered_and_good += isMeasured(state) ? 1 : 0;
  }
  ASSERT_GT(metric.size(), 100U) << daemon->said();
  const Trajectory truth = readTrajectory(way_ + "/groundtruth.txt");
  const AbsoluteError error = absoluteError(trajectoryOf(metric), truth, Alignment::similarity);
  EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.05);
  EXPECT_LT(error.translation.rmse, 0.03);
  EXPECT_GT(covered, 3) << "frames were dropped";
  EXPECT_GE(covered_and_good, covered - 1) << daemon->said();
  EXPECT_EQ(daemon->times("metres a map unit"), 1) << "told once: " << daemon->said();

  const Outcome repeated =
      runProgram({"replay", folder_.path("recording"), "--output", folder_.path("repeated"), "--drawings", "0"});
  EXPECT_EQ(repeated.exit_code, 0) << repeated.messages;
  EXPECT_NE(repeated.output.find("lengths are metres"), std::string::npos) << repeated.output;
}

TEST_F(DaemonWheels, ThatSayNothingAreToldAndTheCameraGoesOnAlone) {
  const auto daemon = startOn(way_, {"--config", configure(used_)});
  EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) {
    return status.scale_reason.find("wheels: nothing has come from it") != std::string::npos;
  })) << daemon->said();
  EXPECT_TRUE(isTracking());
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_EQ(daemon->times("nothing has come from it"), 1) << "told once: " << daemon->said();
}

TEST_F(DaemonWheels, OfWhichItIsNotKnownWhereTheyAreHeardAreRefused) {
  const auto daemon = startOn(way_, {"--config", configure("wheels: {enabled: true}\n")});
  EXPECT_EQ(daemon->exitCode(), 2);
  EXPECT_TRUE(daemon->says("scale.odometry_channel")) << daemon->said();
}

}  // namespace
}  // namespace edgeslam
