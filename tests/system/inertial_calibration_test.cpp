// `edgeslam calibrate --imu` as a user runs it: in a map and before a board, with a unit that is not where its file
// says and whose clock is another one; and what it refuses.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "frames/inertial_file.h"
#include "geometry/angles.h"
#include "simulator/inertial_simulation.h"
#include "system/program.h"
#include "unit/calibration/rendered_board.h"
#include "unit/inertia/turning_camera.h"

namespace edgeslam {
namespace {

constexpr std::int64_t clocks_differ_ns = 23'000'000;
constexpr double largest_rotation_error_deg = 0.5, largest_offset_error_s = 0.0015;

class InertialCalibrationRun : public testing::Test {
 protected:
  // The frames of the simulated sequence, with samples on a clock of their own and a unit that sits 4 degrees off.
  void useFrames() {
    const std::string simulated = std::string(EDGESLAM_RUN_FOLDER) + "/swinging";
    std::filesystem::create_directories(recording_);
    for (const char* name : {"rgb", "rgb.txt", "camera.yaml"}) {
      std::filesystem::create_symlink(simulated + "/" + name, recording_ + "/" + name);
    }
    std::vector<InertialSample> samples = readInertialSamples(simulated + "/imu.csv");
    for (InertialSample& sample : samples) sample.time_ns += clocks_differ_ns;
    folder_.write("recording/imu.csv", formatInertialSamples(samples));
    InertialUnit wrong = readInertialUnit(simulated + "/imu.yaml");
    truth_ = wrong.imu_T_camera;
    wrong.imu_T_camera.rotation = wrong.imu_T_camera.rotation * rotationExp(radians(4) * Eigen::Vector3d(0.6, 0, 0.8));
    folder_.write("recording/imu.yaml", formatInertialUnit(wrong));
  }
  void expectFound(std::int64_t offset_ns) const {
    const InertialUnit found = readInertialUnit(output_);
    EXPECT_LT(degrees(rotationAngle(found.imu_T_camera.rotation, truth_.rotation)), largest_rotation_error_deg);
    EXPECT_LT(1e-9 * std::abs(static_cast<double>(found.offset_ns - offset_ns)), largest_offset_error_s);
    EXPECT_LT((found.imu_T_camera.translation - truth_.translation).norm(), 1e-6) << "it is none of what is found";
  }

  const TemporaryFolder folder_;
  const std::string recording_ = folder_.path("recording"), output_ = folder_.path("found.yaml");
  Pose truth_;  // imu_T_camera
};

TEST_F(InertialCalibrationRun, FindsRotationAndOffsetInAMap) {
  useFrames();
  const std::vector<std::string> command{"calibrate", "--imu", recording_, "--output", output_};
  const Outcome outcome = runProgram(command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_NE(outcome.output.find("degrees from the one given"), std::string::npos) << outcome.output;
  expectFound(clocks_differ_ns);

  const Outcome again = runProgram(command);
  EXPECT_EQ(again.exit_code, 2);
  ASSERT_EQ(again.failures().size(), 1U);
  EXPECT_NE(again.failures()[0].find("--force"), std::string::npos);
}

TEST_F(InertialCalibrationRun, FindsThemFromAFlightRecording) {
  useFrames();
  const std::string recorded = folder_.path("recorded");
  const Outcome run = runProgram({"replay", recording_, "--imu", "--realtime", "--pace", "2", "--record", recorded,
                                  "--output", folder_.path("run"), "--drawings", "0"});
  ASSERT_EQ(run.exit_code, 0) << run.messages;
  const Outcome outcome = runProgram({"calibrate", "--imu", recorded, "--output", output_});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  expectFound(clocks_differ_ns);
}

TEST_F(InertialCalibrationRun, RefusesTurnsAboutOneAxis) {
  const Outcome made = runProgram({"simulate", "corridor", "--frames", "250", "--width", "320", "--height", "240",
                                   "--imu", "--output", recording_});
  ASSERT_EQ(made.exit_code, 0) << made.messages;
  const Outcome outcome = runProgram({"calibrate", "--imu", recording_, "--output", output_});
  EXPECT_EQ(outcome.exit_code, 1);
  ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  EXPECT_NE(outcome.failures()[0].find("turns about one axis only, its y axis"), std::string::npos)
      << outcome.failures()[0];
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(InertialCalibrationRun, FindsThemBeforeABoard) {
  test::TurningCamera turning;
  turning.swing_rad = {0.15, 0.2, 0.2};
  turning.seconds = 9;
  turning.pose_noise_rad = 0;
  const Camera camera{CameraModel::pinhole_radial_tangential, 320, 240, 290, 291, 161, 118, {0.03, -0.05, 0, 0, 0}};
  const Board board = parseBoard("chessboard:7x5:30mm");
  const BoardRenderer renderer(board, camera);
  const Pose world_T_board{Eigen::Quaterniond::Identity(), {-0.09, -0.06, 0.6}};
  std::filesystem::create_directories(recording_ + "/rgb");
  std::string list;
  for (const PosedCamera& posed : turning.poses(1)) {
    const std::string name = "rgb/" + std::to_string(posed.time_ns) + ".png";
    const Pose camera_T_board = posed.world_T_camera.inverse() * world_T_board;
    cv::imwrite(recording_ + "/" + name,
                renderer.render(camera_T_board, {}, static_cast<std::uint64_t>(posed.time_ns)));
    char time[32];
    std::snprintf(time, sizeof time, "%.6f ", 1e-9 * static_cast<double>(posed.time_ns));
    list += time + name + "\n";
  }
  folder_.write("recording/rgb.txt", list);
  folder_.write("recording/camera.yaml",
                "model: pinhole_radial_tangential\nwidth: 320\nheight: 240\nfx: 290\nfy: 291\ncx: 161\ncy: 118\n"
                "k1: 0.03\nk2: -0.05\np1: 0\np2: 0\nk3: 0\n");
  folder_.write("recording/imu.csv", formatInertialSamples(turning.samples(1)));
  truth_.rotation = turning.imu_R_camera;
  const Outcome outcome =
      runProgram({"calibrate", "--imu", recording_, "--board", "chessboard:7x5:30mm", "--output", output_});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_NE(outcome.output.find("none was given"), std::string::npos) << "no imu.yaml lies beside it";
  expectFound(std::llround(turning.offset_s * 1e9));
}

TEST_F(InertialCalibrationRun, WrongUseIsToldInOneLine) {
  useFrames();
  std::filesystem::remove(recording_ + "/imu.csv");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"calibrate", "--imu"},
                                             {"calibrate", "--imu", recording_},
                                             {"calibrate", "--imu", "--readout", recording_},
                                             {"calibrate", "--imu", "--camera", "x"},
                                             {"calibrate", "--imu", "/no/such/folder"}}) {
    const Outcome outcome = runProgram(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  }
  EXPECT_NE(runProgram({"calibrate", "--imu", recording_}).messages.find("no imu.csv"), std::string::npos);
}

}  // namespace
}  // namespace edgeslam
