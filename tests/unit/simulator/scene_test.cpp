#include "simulator/scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "simulator/scene_lighting.h"

namespace edgeslam {
namespace {

class SceneKinds : public testing::TestWithParam<SceneKind> {};

TEST_P(SceneKinds, RectanglesAreSound) {
  const Scene scene = makeScene(GetParam(), 1);
  for (const SceneRectangle& r : scene.rectangles) {
    EXPECT_GT(r.side_s.norm(), 1e-3);
    EXPECT_GT(r.side_t.norm(), 1e-3);
    EXPECT_NEAR(r.side_s.dot(r.side_t), 0, 1e-9);
    EXPECT_GE(r.albedo, 0);
    EXPECT_LE(r.albedo, 1);
    EXPECT_LT(r.texture, static_cast<int>(scene.textures.size()));
    EXPECT_GE(r.corner.z(), -1e-9);
  }
}

TEST_P(SceneKinds, EverySurfaceGetsSomeLight) {
  const Scene scene = makeScene(GetParam(), 1);
  const std::vector<cv::Mat> light = computeLight(scene);
  ASSERT_EQ(light.size(), scene.rectangles.size());
  for (const cv::Mat& map : light) {
    double least = 0, most = 0;
    cv::minMaxLoc(map, &least, &most);
    EXPECT_GE(least, 0);
    EXPECT_GT(most, 0.005);
    EXPECT_LT(most, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SceneKinds,
                         testing::Values(SceneKind::panels, SceneKind::panels_textured, SceneKind::room,
                                         SceneKind::corridor, SceneKind::corridor_tiled),
                         [](const auto& scene) { return sceneName(scene.param); });

TEST(SceneLighting, NeighbouringPanelsDifferInBrightness) {
  const Scene scene = makeScene(SceneKind::panels, 1);
  const std::vector<cv::Mat> light = computeLight(scene);
  std::vector<double> fronts;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const SceneRectangle& r = scene.rectangles[i];
    const Eigen::Vector3d normal = r.side_s.cross(r.side_t).normalized();
    if (normal.y() < -0.5 && std::min(r.side_s.norm(), r.side_t.norm()) > 0.5 &&
        std::abs(r.side_s.z() + r.side_t.z() - 1.95) < 1e-6)
      fronts.push_back(cv::mean(light[i])[0]);
  }
  ASSERT_EQ(fronts.size(), 7U);
  int unlike = 0;
  for (std::size_t i = 1; i < fronts.size(); ++i) {
    unlike += std::abs(fronts[i] - fronts[i - 1]) > 0.08 * std::max(fronts[i], fronts[i - 1]) ? 1 : 0;
  }
  EXPECT_GE(unlike, 5);
}

TEST(SceneLighting, ShadowsAndCornersAreDarker) {
  Scene scene;
  SceneRectangle floor;
  floor.corner = {-2, -2, 0};
  floor.side_s = {4, 0, 0};
  floor.side_t = {0, 4, 0};
  SceneRectangle roof = floor;  // over the half x < 0, half a metre up
  roof.corner.z() = 0.5;
  roof.side_s = {2, 0, 0};
  scene.rectangles = {floor, roof};
  scene.lights = {{{0, 0, 3}, {0, 0, -1}, 2}};
  const cv::Mat light = computeLight(scene)[0];
  EXPECT_LT(light.at<float>(light.rows / 2, light.cols / 4),
            0.7 * static_cast<double>(light.at<float>(light.rows / 2, light.cols * 3 / 4)));
}

}  // namespace
}  // namespace edgeslam
