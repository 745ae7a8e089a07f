// `edgeslam run` on a simulated sequence as a stand-in camera, with a robot that listens.
#pragma once

#include <map>
#include <memory>

#include "evaluation/evaluation.h"
#include "system/daemon/robot.h"
#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"
#include "system/program.h"

namespace edgeslam {

class DaemonTest : public OwnNetwork {
 protected:
  using Options = std::vector<std::string>;

  void SetUp() override {
    OwnNetwork::SetUp();
    if (!IsSkipped() && !HasFatalFailure()) robot_ = std::make_unique<Robot>();
  }

  std::unique_ptr<BackgroundProcess> start(const Options& options) {
    Options command{EDGESLAM_PROGRAM};
    command.insert(command.end(), options.begin(), options.end());
    return std::make_unique<BackgroundProcess>(command);
  }
  std::unique_ptr<BackgroundProcess> startOn(const std::string& sequence, Options options = {}) {
    options.insert(options.begin(), {"run", "--source", sequence});
    return start(options);
  }
  std::string configure(const std::string& text) const { return folder_.write("robot.yaml", text); }
  // [m] after similarity alignment.
  static double errorOf(const Trajectory& trajectory, const std::string& sequence) {
    return absoluteError(trajectory, readTrajectory(sequence + "/groundtruth.txt"), Alignment::similarity)
        .translation.rmse;
  }
  bool isTracking() const { return robot_->hearsState(isMeasured); }
  // A recording gives the poses that were published meanwhile.
  void expectRepeats(const std::string& recording) const {
    const Outcome repeated = runProgram({"replay", recording, "--output", folder_.path("repeated"), "--drawings", "0"});
    ASSERT_EQ(repeated.exit_code, 0) << repeated.messages;
    std::map<std::int64_t, Pose> published;
    for (const StampedPose& pose : trajectoryOf(robot_->heard().states)) published[pose.time_ns] = pose.world_T_camera;
    const Trajectory again = readTrajectory(folder_.path("repeated/trajectory_live.txt"));
    ASSERT_GT(again.size(), 25U);
    for (const StampedPose& pose : again) {
      const auto first = published.find(pose.time_ns / 1000 * 1000);
      ASSERT_NE(first, published.end()) << pose.time_ns;
      EXPECT_LT((first->second.translation - pose.world_T_camera.translation).norm(), 1e-6) << pose.time_ns;
    }
  }

  const std::string parlour_ = std::string(EDGESLAM_RUN_FOLDER) + "/parlour";  // 300 frames, 10 s
  TemporaryFolder folder_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace edgeslam
