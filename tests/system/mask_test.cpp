// A robot that sees its own plate: a mask is proposed from a recording, and runs with it look past the plate. The
// sequence is made by ctest (see CMakeLists.txt), the plate is drawn in here.
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "system/run_result.h"

namespace edgeslam {
namespace {

constexpr int plate_rows = 48;

void drawPlate(cv::Mat& grey) {
  grey.rowRange(0, plate_rows).setTo(35);
  for (int x = 10; x + 20 < grey.cols; x += 40) {
    grey(cv::Rect(x, 8, 8, 8)).setTo(150);
    grey(cv::Rect(x + 12, 26, 12, 10)).setTo(220);
  }
}

class Mask : public ::testing::Test {
 protected:
  // The sequence past the plate.
  void SetUp() override {
    const std::string made = std::string(EDGESLAM_RUN_FOLDER) + "/parlour_quick";
    std::istringstream list(fileContent(made + "/rgb.txt"));
    folder_.write("plate/rgb.txt", list.str());
    folder_.write("plate/camera.yaml", fileContent(made + "/camera.yaml"));
    folder_.write("plate/groundtruth.txt", fileContent(made + "/groundtruth.txt"));
    std::filesystem::create_directory(folder_.path("plate/rgb"));
    int frames = 0;
    for (std::string line; std::getline(list, line);) {
      if (line.empty() || line[0] == '#') continue;
      const std::string image = line.substr(line.find(' ') + 1);
      cv::Mat grey = cv::imread(made + "/" + image, cv::IMREAD_GRAYSCALE);
      ASSERT_FALSE(grey.empty()) << made << " is missing: these tests need ctest's fixtures, which make it";
      drawPlate(grey);
      cv::imwrite(folder_.path("plate/" + image), grey);
      ++frames;
    }
    ASSERT_GT(frames, 200);
    cv::Mat mask(240, 320, CV_8U, cv::Scalar(255));
    mask.rowRange(0, plate_rows).setTo(0);
    cv::imwrite(folder_.path("by_hand.png"), mask);
    folder_.write("by_hand.yaml", "camera: {calibration: plate/camera.yaml, mask: by_hand.png}\n");
  }
  std::string sequence() const { return folder_.path("plate"); }

  const TemporaryFolder folder_;
};

TEST_F(Mask, IsProposedFromARecording) {
  const std::string output = folder_.path("mask.png");
  const Outcome outcome = runProgram({"mask", sequence(), "--output", output});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_EQ(outcome.output.rfind(output + ": ", 0), 0U) << outcome.output;
  EXPECT_NE(outcome.output.find(" % of the image is masked"), std::string::npos) << outcome.output;
  const cv::Mat mask = cv::imread(output, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(mask.type(), CV_8U);
  ASSERT_EQ(mask.size(), cv::Size(320, 240));
  EXPECT_LT(cv::countNonZero(mask.rowRange(0, plate_rows)), 0.03 * 320 * plate_rows);
  EXPECT_EQ(cv::countNonZero(mask.rowRange(plate_rows + 20, 240) == 0), 0);
  const cv::Mat overlay = cv::imread(folder_.path("mask_overlay.png"), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(overlay.type(), CV_8UC3);
  EXPECT_EQ(overlay.size(), mask.size());

  const Outcome again = runProgram({"mask", sequence(), "--output", output});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.messages.find("is there already"), std::string::npos) << again.messages;
}

TEST_F(Mask, IsNotProposedWhereTheCameraStandsStillOrNothingIsInItsWay) {
  const std::string made = std::string(EDGESLAM_RUN_FOLDER);
  const std::string output = folder_.path("mask.png");
  const Outcome still = runProgram({"mask", made + "/hall_still", "--output", output});
  EXPECT_EQ(still.exit_code, 2);
  ASSERT_EQ(still.failures().size(), 1U) << still.messages;
  EXPECT_NE(still.messages.find("the camera hardly moves"), std::string::npos) << still.messages;
  const Outcome free = runProgram({"mask", made + "/parlour_quick", "--output", output});
  EXPECT_EQ(free.exit_code, 1);
  ASSERT_EQ(free.failures().size(), 1U) << free.messages;
  EXPECT_NE(free.messages.find("no mask is needed"), std::string::npos) << free.messages;
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(Mask, TheRunLooksPastThePlate) {
  const ReplayedRun masked = replayed(sequence(), folder_.path("masked"), {"--config", folder_.path("by_hand.yaml")});
  ASSERT_EQ(masked.outcome.exit_code, 0) << masked.outcome.messages;
  const int last = static_cast<int>(masked.states.size()) - 1, first = masked.firstGood(0);
  ASSERT_GE(first, 0);
  EXPECT_LE(last - first + 1 - masked.countGood(first, last), 5);
  const Trajectory truth = readTrajectory(sequence() + "/groundtruth.txt");
  EXPECT_LT(largestError(readTrajectory(masked.folder + "/trajectory.txt"), truth), 0.1);
  replayed(sequence(), folder_.path("plain"));
  EXPECT_GT(largestError(readTrajectory(folder_.path("plain/trajectory.txt")), truth), 0.3)
      << "the case is no test of the mask";
}

TEST_F(Mask, ARecordingOfALiveRunHasItAndRepeatsTheRun) {
  const Outcome live =
      runProgram({"replay", sequence(), "--config", folder_.path("by_hand.yaml"), "--realtime", "--record",
                  folder_.path("recording"), "--output", folder_.path("live"), "--drawings", "0"});
  ASSERT_EQ(live.exit_code, 0) << live.messages;
  EXPECT_EQ(cv::norm(cv::imread(folder_.path("recording/mask.png"), cv::IMREAD_UNCHANGED),
                     cv::imread(folder_.path("by_hand.png"), cv::IMREAD_UNCHANGED), cv::NORM_INF),
            0);
  std::filesystem::remove(folder_.path("by_hand.png"));
  const Outcome repeated =
      runProgram({"replay", folder_.path("recording"), "--output", folder_.path("repeated"), "--drawings", "0"});
  ASSERT_EQ(repeated.exit_code, 0) << repeated.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(folder_.path("live") + "/" + name) == fileContent(folder_.path("repeated") + "/" + name))
        << name;
  }
}

TEST_F(Mask, BadOnesAreToldInOneLine) {
  cv::imwrite(folder_.path("small.png"), cv::Mat(24, 32, CV_8U, cv::Scalar(255)));
  cv::imwrite(folder_.path("black.png"), cv::Mat(240, 320, CV_8U, cv::Scalar(0)));
  folder_.write("text.png", "black on top");
  const auto expectRefused = [&](const std::string& mask, const std::string& expected) {
    // The calibration is beside the frames.
    const std::string configuration = folder_.write("bad.yaml", "camera:\n  mask: " + mask + "\n");
    const Outcome outcome = runProgram(
        {"replay", sequence(), "--config", configuration, "--output", folder_.path("result"), "--drawings", "0"});
    EXPECT_EQ(outcome.exit_code, 2);
    ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
    for (const std::string& text : {configuration, std::string("camera.mask: "), mask, expected}) {
      EXPECT_NE(outcome.failures()[0].find(text), std::string::npos) << "no '" << text << "' in " << outcome.messages;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_.path("result")));
  };
  expectRefused("small.png", "is 32 x 24 pixels, expected the camera's size, 320 x 240");
  expectRefused("black.png", "expected black only where");
  expectRefused("text.png", "expected an image of the camera's size");
  expectRefused("none.png", "no such file");
}

}  // namespace
}  // namespace edgeslam
