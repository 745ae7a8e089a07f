#include "app/check_config_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "app/command_line.h"
#include "unit/dataset/temporary_folder.h"

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
