#include "app/check_config_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "app/command_line.h"
#include "configuration/configuration.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

struct Outcome {
  int exit_code = -1;
  std::string output, errors;
};

Outcome checkConfig(const std::string& argument) {
  const std::vector<const char*> arguments{"edgeslam", "check-config", argument.c_str()};
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.exit_code = runCommandLine(static_cast<int>(arguments.size()), arguments.data());
  outcome.output = ::testing::internal::GetCapturedStdout();
  outcome.errors = ::testing::internal::GetCapturedStderr();
  return outcome;
}

TEST(CheckConfig, ListsWhatDiffersFromTheDefaults) {
  const TemporaryFolder folder;
  const Outcome outcome = checkConfig(folder.write("a.yaml", "edges: {sigma: 2.5, sigma_ratio: 1.26}\n"));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("edges.sigma: 2.5 (default 1.78)"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("sigma_ratio"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.errors, "");
}

TEST(CheckConfig, ListsEveryProblem) {
  const TemporaryFolder folder;
  const Outcome outcome = checkConfig(folder.write("a.yaml", "edges: {sigma: -1}\npose: {huber: x, y: 1}\n"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 3) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
}

TEST(CheckConfig, AWrongCalibrationIsRefused) {
  const TemporaryFolder folder;
  const Outcome outcome =
      checkConfig(folder.write("a.yaml", "width: 640\nheight: 480\nfx: .nan\nfy: 500\ncx: 320\ncy: 240\n"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("a.yaml:3"), std::string::npos) << outcome.errors;
}

TEST(CheckConfig, AllCommittedFilesAreGood) {
  int cameras = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(EDGESLAM_SOURCE_DIR "/firmware_cfg")) {
    if (entry.path().extension() != ".yaml") continue;
    const Outcome outcome = checkConfig(entry.path().string());
    EXPECT_EQ(outcome.exit_code, 0) << entry.path() << ": " << outcome.errors;
    cameras += entry.path().parent_path().filename() == "cameras" ? 1 : 0;
  }
  EXPECT_GE(cameras, 5);
}

TEST(CheckConfig, ExamplesOfRobotsLookAheadAndSayWhatTheirCameraIs) {
  int robots = 0;
  for (const auto& entry : std::filesystem::directory_iterator(EDGESLAM_SOURCE_DIR "/firmware_cfg/robots")) {
    const Configuration robot = readConfiguration(entry.path().string());
    ++robots;
    ASSERT_TRUE(robot.camera) << entry.path();
    EXPECT_EQ(robot.capture.width, robot.camera->width) << entry.path();
    EXPECT_EQ(robot.capture.height, robot.camera->height) << entry.path();
    const Eigen::Quaterniond& body_R_camera = robot.body_T_camera.rotation;
    EXPECT_GT((body_R_camera * Eigen::Vector3d::UnitZ()).x(), 0.7) << "looks ahead: " << entry.path();
    EXPECT_LE((body_R_camera * Eigen::Vector3d::UnitZ()).z(), 1e-9) << "and never up: " << entry.path();
    EXPECT_LT((body_R_camera * Eigen::Vector3d::UnitX()).y(), -0.999) << "its right is the robot's: " << entry.path();
  }
  EXPECT_GE(robots, 3);
}

TEST(CheckConfig, NominalCalibrationsSayThatTheyAreNoMeasurements) {
  int nominal = 0;
  for (const auto& entry : std::filesystem::directory_iterator(EDGESLAM_SOURCE_DIR "/firmware_cfg/cameras")) {
    const std::string name = entry.path().filename();
    if (name.rfind("raspberry", 0) != 0 && name.rfind("usb", 0) != 0) continue;
    ++nominal;
    std::ifstream file(entry.path());
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    EXPECT_NE(text.find("NOMINAL"), std::string::npos) << name;
  }
  EXPECT_GE(nominal, 7);
}

TEST(CheckConfig, PrintsTheDefaultsAsAFileThatIsGood) {
  const TemporaryFolder folder;
  const Outcome printed = checkConfig("--print-default");
  EXPECT_EQ(printed.exit_code, 0);
  const Outcome outcome = checkConfig(folder.write("a.yaml", printed.output));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("all settings are the defaults"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace edgeslam
