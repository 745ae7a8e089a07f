// A run over what was measured beside the frames of a simulated sequence, against the truth.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "system/run_result.h"

namespace edgeslam {

class MeasuredBesideTest : public testing::Test {
 protected:
  // `sequence`: in EDGESLAM_RUN_FOLDER.
  explicit MeasuredBesideTest(const std::string& sequence)
      : input_(std::string(EDGESLAM_RUN_FOLDER) + "/" + sequence) {}

  ReplayedRun replayedWith(const std::string& name, const std::vector<std::string>& more) const {
    return runOver(input_, name, more);
  }
  ReplayedRun runOver(const std::string& sequence, const std::string& name,
                      const std::vector<std::string>& more = {"--imu"}) const {
    ReplayedRun run = replayed(sequence, folder_.path(name), more);
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.messages;
    return run;
  }
  // The sequence with another imu.yaml beside it; its folder.
  std::string sequenceWithUnit(const std::string& name, const std::string& imu_yaml) const {
    std::filesystem::create_directories(folder_.path(name));
    for (const char* file : {"rgb", "rgb.txt", "camera.yaml", "groundtruth.txt", "imu.csv"}) {
      std::filesystem::create_symlink(input_ + "/" + file, folder_.path(name + "/" + file));
    }
    folder_.write(name + "/imu.yaml", imu_yaml);
    return folder_.path(name);
  }
  void expectSameBytes(const std::string& one, const std::string& other) const {
    for (const char* name : {"/trajectory.txt", "/trajectory_live.txt", "/map.ply"}) {
      EXPECT_TRUE(fileContent(folder_.path(one + name)) == fileContent(folder_.path(other + name))) << name;
    }
  }
  AbsoluteError errorOf(const std::string& name) const {
    return absoluteError(readTrajectory(folder_.path(name + "/trajectory.txt")),
                         readTrajectory(input_ + "/groundtruth.txt"), Alignment::similarity);
  }

  const std::string input_;
  const TemporaryFolder folder_;
};

}  // namespace edgeslam
