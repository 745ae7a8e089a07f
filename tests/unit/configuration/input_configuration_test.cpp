#include "configuration/input_configuration.h"

#include <gtest/gtest.h>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

// Frames that bring what the test gives them, and none of themselves.
class NoFrames : public FrameSource {
 public:
  NoFrames(std::optional<Camera> camera, cv::Size size) : camera_(std::move(camera)), size_(size) {}
  std::optional<Frame> next() override { return std::nullopt; }
  std::int64_t size() const override { return 0; }
  std::string kind() const override { return "none"; }
  std::optional<Camera> camera() const override { return camera_; }
  cv::Size videoSize() const override { return size_; }
  std::string groundTruthPath() const override { return ""; }

 private:
  std::optional<Camera> camera_;
  cv::Size size_;
};

Camera cameraBeside() {
  return {CameraModel::pinhole_radial_tangential, 640, 480, 500, 500, 320, 240, {0.02, 0.04, 0, 0, 0}};
}

bool isPresumed(const Configuration& configuration) {
  return configuration.settings.mapping.camera_finding.lens_is_presumed;
}

TEST(InputConfiguration, TheLensOfAVideoAloneIsPresumed) {
  const NoFrames video(std::nullopt, {1280, 720});
  const Configuration configuration = configurationFor(video, "");
  EXPECT_TRUE(isPresumed(configuration));
  const Camera camera = cameraFor(video, configuration, "video.mp4");
  EXPECT_EQ(camera.width, 1280);
  EXPECT_EQ(camera.height, 720);
  EXPECT_EQ(camera.fx, 0.8 * 1280);
  EXPECT_EQ(presumedLens(configuration).find("only the camera's size is known"), 0U) << presumedLens(configuration);
}

TEST(InputConfiguration, ACalibrationGoesBeforeAPresumedLens) {
  const NoFrames video(cameraBeside(), {640, 480});
  const Configuration beside = configurationFor(video, "");
  EXPECT_FALSE(isPresumed(beside));
  EXPECT_EQ(cameraFor(video, beside, "video.mp4").fx, 500);
  const TemporaryFolder folder;
  const std::string file =
      folder.write("file.yaml", "camera: {width: 640, height: 480, fx: 510, fy: 510, cx: 320, cy: 240}\n");
  const Configuration given = configurationFor(NoFrames(std::nullopt, {640, 480}), file);
  EXPECT_FALSE(isPresumed(given));
  EXPECT_EQ(given.camera->fx, 510);
}

TEST(InputConfiguration, NothingIsPresumedOfOtherFramesNorWhereNothingIsLookedFor) {
  EXPECT_THROW(cameraFor(NoFrames(std::nullopt, {}), Configuration(), "folder"), InputError);
  const TemporaryFolder folder;
  const std::string file = folder.write("file.yaml", "camera_finding: {enabled: false}\n");
  for (const auto& [size, configuration] : {std::pair(cv::Size(), std::string()), {cv::Size(640, 480), file}}) {
    const NoFrames frames(std::nullopt, size);
    EXPECT_THROW(cameraFor(frames, configurationFor(frames, configuration), "input"), InputError);
  }
}

TEST(InputConfiguration, ADistortionBesideTheFramesThatCannotBeRightIsTold) {
  EXPECT_EQ(calibrationDoubt(cameraBeside(), Configuration()), "");
  Camera folding = cameraBeside();
  folding.fx = folding.fy = 320;
  folding.distortion[4] = -0.08;
  const NoFrames frames(folding, {});
  EXPECT_NE(calibrationDoubt(folding, Configuration()).find("cannot be right"), std::string::npos);
  EXPECT_EQ(cameraFor(frames, Configuration(), "folder").distortion[4], 0);
}

}  // namespace
}  // namespace edgeslam
