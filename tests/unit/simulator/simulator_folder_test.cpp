#include "simulator/simulator_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>

#include "edgeslam/input_error.h"
#include "evaluation/trajectory.h"
#include "frames/frame_source.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

class SimulatorFolder : public testing::Test {
 protected:
  SimulatorFolder() {
    std::string name = (fs::temp_directory_path() / "simulator_folder_XXXXXX").string();
    base_ = mkdtemp(name.data());
  }
  ~SimulatorFolder() override {
    std::error_code ignored;
    fs::remove_all(base_, ignored);
  }
  SimulatorFolder(const SimulatorFolder&) = delete;
  SimulatorFolder& operator=(const SimulatorFolder&) = delete;

  static SimulatedSequence shortSequence(bool fisheye = false, double readout_ms = 0) {
    SimulationOptions options;
    options.scene = SceneKind::panels;
    options.frames = 3;
    options.width = 96;
    options.height = 72;
    options.fisheye = fisheye;
    options.readout_ms = readout_ms;
    return makeSequence(options);
  }
  bool baseIsEmpty() const { return fs::is_empty(base_); }
  fs::path base_;
};

TEST_F(SimulatorFolder, IsReadBackAsItWasMade) {
  for (const bool fisheye : {false, true}) {
    const SimulatedSequence sequence = shortSequence(fisheye);
    const std::string folder = (base_ / (fisheye ? "fisheye" : "pinhole")).string();
    int last = 0;
    writeSequence(sequence, folder, false, [&last](int done) { last = done; });
    EXPECT_EQ(last, 3);
    const auto source = openFrames(folder);
    ASSERT_TRUE(source->camera().has_value());
    const Camera camera = *source->camera();
    EXPECT_EQ(camera.model, sequence.camera.model);
    EXPECT_EQ(camera.width, 96);
    EXPECT_EQ(camera.height, 72);
    EXPECT_NEAR(camera.fx, sequence.camera.fx, 1e-6);
    EXPECT_NEAR(camera.fy, sequence.camera.fy, 1e-6);
    EXPECT_NEAR(camera.cx, sequence.camera.cx, 1e-6);
    EXPECT_NEAR(camera.cy, sequence.camera.cy, 1e-6);
    EXPECT_EQ(camera.distortion, sequence.camera.distortion);
    const Trajectory truth = readTrajectory(source->groundTruthPath());
    ASSERT_EQ(truth.size(), 3U);
    for (int i = 0; i < 3; ++i) {
      const auto frame = source->next();
      const SimulatedFrame expected = sequence.frame(i);
      ASSERT_TRUE(frame.has_value());
      EXPECT_EQ(frame->time_ns, expected.time_ns);
      EXPECT_EQ(cv::norm(frame->grey, expected.grey, cv::NORM_INF), 0);
      const StampedPose& pose = truth[static_cast<std::size_t>(i)];
      EXPECT_EQ(pose.time_ns, expected.time_ns);
      EXPECT_LT((pose.world_T_camera.translation - expected.world_T_camera.translation).norm(), 1e-7);
      EXPECT_LT(rotationAngle(pose.world_T_camera.rotation, expected.world_T_camera.rotation), 1e-7);
    }
    EXPECT_FALSE(source->next().has_value());
  }
}

TEST_F(SimulatorFolder, TheCalibrationHasTheReadoutOfARollingShutter) {
  for (const double readout_ms : {0.0, 24.0, -7.5}) {
    const SimulatedSequence sequence = shortSequence(false, readout_ms);
    const std::string text = formatCalibration(sequence.camera, sequence.options);
    EXPECT_EQ(text.find("readout: 0.024\n") != std::string::npos, readout_ms == 24) << text;
    EXPECT_EQ(text.find("readout: -0.0075\n") != std::string::npos, readout_ms == -7.5) << text;
    EXPECT_EQ(text.find("readout") == std::string::npos, readout_ms == 0) << text;
    writeSequence(sequence, (base_ / "out").string(), true, {});
    EXPECT_NEAR(openFrames((base_ / "out").string())->camera()->readout_s, 1e-3 * readout_ms, 1e-12);
  }
}

TEST_F(SimulatorFolder, ListsTheTrianglesOfAllSurfaces) {
  const SimulatedSequence sequence = shortSequence();
  writeSequence(sequence, (base_ / "out").string(), false, {});
  std::ifstream file(base_ / "out" / "surfaces.txt");
  std::string line;
  std::size_t triangles = 0;
  while (std::getline(file, line)) {
    if (line[0] == '#') continue;
    std::istringstream numbers(line);
    double value = 0;
    int count = 0;
    while (numbers >> value) ++count;
    EXPECT_EQ(count, 9);
    ++triangles;
  }
  EXPECT_EQ(triangles, 2 * sequence.scene.scene.rectangles.size());
}

TEST_F(SimulatorFolder, RefusesAFolderInUseUnlessForced) {
  const SimulatedSequence sequence = shortSequence();
  std::ofstream(base_ / "notes.txt") << "mine";
  std::ofstream(base_ / "rgb.txt") << "old";
  EXPECT_THROW(writeSequence(sequence, base_.string(), false, {}), InputError);
  EXPECT_EQ(fs::file_size(base_ / "rgb.txt"), 3U);
  writeSequence(sequence, base_.string(), true, {});
  EXPECT_GT(fs::file_size(base_ / "rgb.txt"), 3U);
  EXPECT_TRUE(fs::exists(base_ / "notes.txt"));
  EXPECT_EQ(std::distance(fs::directory_iterator(base_), fs::directory_iterator()), 6);
}

TEST_F(SimulatorFolder, RefusesAFileInPlaceOfAFolder) {
  std::ofstream(base_ / "file") << "mine";
  EXPECT_THROW(writeSequence(shortSequence(), (base_ / "file").string(), true, {}), InputError);
  EXPECT_THROW(writeSequence(shortSequence(), (base_ / "file" / "below").string(), false, {}), InputError);
  EXPECT_EQ(fs::file_size(base_ / "file"), 4U);
}

TEST_F(SimulatorFolder, LeavesNothingWhereWritingFails) {
  const SimulatedSequence sequence = shortSequence();
  // A limit on the size of files fails as a full disk does: in the middle of a write.
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &usual), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = usual;
  small.rlim_cur = 2000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(writeSequence(sequence, (base_ / "deep" / "out").string(), false, {}), InputError);
  setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(baseIsEmpty());
}

}  // namespace
}  // namespace edgeslam
