// `edgeslam run` on a simulated sequence as a stand-in camera, with a robot that listens.
#pragma once

#include <memory>

#include "evaluation/evaluation.h"
#include "system/daemon/robot.h"
#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"

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

  const std::string parlour_ = std::string(EDGESLAM_RUN_FOLDER) + "/parlour";  // 300 frames, 10 s
  TemporaryFolder folder_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace edgeslam
