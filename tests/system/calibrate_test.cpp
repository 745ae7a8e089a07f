// `edgeslam calibrate` as a user runs it: prints a board, calibrates from a folder, and from a camera that a recording
// stands for.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "frames/calibration_file.h"
#include "system/program.h"
#include "unit/calibration/rendered_board.h"

namespace edgeslam {
namespace {

const char* const kBoard = "chessboard:7x5:30mm";

Camera camera() {
  return {CameraModel::pinhole_radial_tangential, 320, 240, 290, 291, 161, 118, {0.03, -0.05, 0, 0, 0}};
}

class Calibrate : public testing::Test {
 protected:
  // Frames in TUM layout. `interval_ms`: from the first of a view's frames to the next view's; each is there twice,
  // 30 ms apart, as a video has a board that stands still.
  void writeFrames(int interval_ms) {
    const Board board = parseBoard(kBoard);
    const BoardRenderer renderer(board, camera());
    std::string list;
    std::filesystem::create_directories(folder_.path("frames/rgb"));
    int time_ms = 1000;
    for (const Hold& hold : goodHolds(camera())) {
      const cv::Mat grey = renderer.render(heldPose(board, camera(), hold), {}, static_cast<std::uint64_t>(time_ms));
      for (const int later_ms : {0, 30}) {
        const std::string time = std::to_string((time_ms + later_ms) / 1000) + "." + milliseconds(time_ms + later_ms);
        cv::imwrite(folder_.path("frames/rgb/" + time + ".png"), grey);
        list += time + " rgb/" + time + ".png\n";
      }
      time_ms += interval_ms;
    }
    folder_.write("frames/rgb.txt", list);
  }
  static std::string milliseconds(int time_ms) {
    const std::string digits = std::to_string(time_ms % 1000);
    return std::string(3 - digits.size(), '0') + digits;
  }

  TemporaryFolder folder_;
  std::string output_ = folder_.path("camera.yaml");
};

TEST_F(Calibrate, FromAFolderGivesAFileThatTheProgramReads) {
  writeFrames(500);
  const std::vector<std::string> command{"calibrate", folder_.path("frames"), "--board", kBoard, "--output", output_};
  const Outcome outcome = runProgram(command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_NE(outcome.output.find("views held back"), std::string::npos);
  EXPECT_NE(outcome.messages.find("next: "), std::string::npos) << "guidance";
  EXPECT_LT(cameraDifference(camera(), readCalibration(output_)).rms_px, 0.25);
  EXPECT_EQ(runProgram({"check-config", output_}).exit_code, 0);

  const Outcome again = runProgram(command);
  EXPECT_EQ(again.exit_code, 2);
  ASSERT_EQ(again.failures().size(), 1U);
  EXPECT_NE(again.failures()[0].find("--force"), std::string::npos);

  const Outcome other = runProgram(
      {"calibrate", folder_.path("frames"), "--board", "chessboard:9x6:30mm", "--output", folder_.path("other.yaml")});
  EXPECT_EQ(other.exit_code, 2);
  ASSERT_EQ(other.failures().size(), 1U);
  EXPECT_NE(other.failures()[0].find("there is a chessboard of 7 x 5 inner corners"), std::string::npos)
      << other.failures()[0];
  EXPECT_FALSE(std::filesystem::exists(folder_.path("other.yaml")));
}

TEST_F(Calibrate, FromACameraEndsByItself) {
  writeFrames(140);
  const Outcome outcome =
      runProgram({"calibrate", "--camera", folder_.path("frames"), "--board", kBoard, "--output", output_});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_LT(cameraDifference(camera(), readCalibration(output_)).rms_px, 0.3);
}

TEST_F(Calibrate, TakesStillsOfAnyNames) {
  for (int i = 0; i < 3; ++i) {
    cv::imwrite(folder_.path("IMG_" + std::to_string(i) + ".png"), cv::Mat(240, 320, CV_8U, cv::Scalar(90)));
  }
  const Outcome outcome = runProgram({"calibrate", folder_.path(), "--board", kBoard, "--output", output_});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.messages.find("is found in none of 3 frames"), std::string::npos) << outcome.messages;

  cv::imwrite(folder_.path("IMG_3.png"), cv::Mat(100, 100, CV_8U, cv::Scalar(90)));
  const Outcome mixed = runProgram({"calibrate", folder_.path(), "--board", kBoard, "--output", output_});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_NE(mixed.messages.find("100 x 100"), std::string::npos) << mixed.messages;
}

TEST_F(Calibrate, WritesABoardToPrint) {
  const std::vector<std::string> command{"calibrate", "board", "--type",   "aprilgrid",
                                         "--columns", "6",     "--rows",   "5",
                                         "--square",  "26mm",  "--output", folder_.path("board.pdf")};
  const Outcome outcome = runProgram(command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_NE(outcome.output.find("--board aprilgrid:6x5:26mm:0.3"), std::string::npos);
  EXPECT_EQ(fileContent(folder_.path("board.pdf")).compare(0, 5, "%PDF-"), 0);
  EXPECT_EQ(runProgram(command).exit_code, 2) << "it is there already";
}

TEST_F(Calibrate, WrongUseIsToldInOneLine) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"calibrate"},
                                             {"calibrate", folder_.path()},
                                             {"calibrate", "--board", kBoard},
                                             {"calibrate", folder_.path(), "--camera", "x", "--board", kBoard},
                                             {"calibrate", "/no/such/folder", "--board", kBoard, "--output", output_},
                                             {"calibrate", folder_.path(), "--board", "squares", "--output", output_},
                                             {"calibrate", "board", "--columns", "9", "--rows", "6"},
                                             {"calibrate", "board", "--columns", "9", "--rows", "6", "--square", "1m",
                                              "--output", folder_.path("x.pdf")}}) {
    const Outcome outcome = runProgram(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  }
}

}  // namespace
}  // namespace edgeslam
