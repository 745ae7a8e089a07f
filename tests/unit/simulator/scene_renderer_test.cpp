#include "simulator/scene_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "edgeslam/input_error.h"
#include "simulator/scene_visibility.h"
#include "unit/simulator/image_edge.h"

namespace edgeslam {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Cameras stand at the origin of the world's axes: the tests' scenes are given in the camera frame.
Camera smallCamera(bool fisheye) {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = 110;
  camera.fy = 112;
  camera.cx = 78.3;
  camera.cy = 61.7;
  camera.distortion = {-0.22, 0.05, 0.001, -0.0015, 0};
  if (fisheye) {
    camera.model = CameraModel::kannala_brandt;
    camera.distortion = {-0.03, 0.01, -0.004, 0.001, 0};
  }
  return camera;
}

SceneRectangle rectangle(const Vector3d& corner, const Vector3d& side_s, const Vector3d& side_t, double albedo) {
  SceneRectangle r;
  r.corner = corner;
  r.side_s = side_s;
  r.side_t = side_t;
  r.albedo = albedo;
  return r;
}

void add(LitScene& lit, const SceneRectangle& r) {
  lit.scene.rectangles.push_back(r);
  lit.light.emplace_back(2, 2, CV_32F, cv::Scalar(1));
}

// A bright, slanted rectangle before a dark wall. Its front is turned to the camera: s x t points to -z.
LitScene slantedRectangle() {
  LitScene lit;
  add(lit, rectangle({-20, 20, 6}, {40, 0, 0}, {0, -40, 0}, 0.1));
  const Vector3d s = Vector3d(0.9, 0.13, 0.35), t = Vector3d(0.1, -0.75, 0).normalized();
  add(lit, rectangle({-0.42, 0.33, 1.6}, s, 0.8 * (t - t.dot(s) / s.squaredNorm() * s), 0.9));
  return lit;
}

// Offsets of the image's edge from the projected one, over points on the rectangle's four sides.
std::vector<double> edgeOffsets(const Camera& camera, const cv::Mat& radiance, const SceneRectangle& r,
                                const Pose& camera_T_world, double reach) {
  std::vector<double> offsets;
  const auto at = [&](double s, double t) {
    return project(camera, camera_T_world * (r.corner + s * r.side_s + t * r.side_t));
  };
  for (double share = 0.15; share < 0.86; share += 0.05) {
    for (const auto& [s, t, ds, dt] :
         std::vector<std::array<double, 4>>{{share, 0, 1, 0}, {share, 1, 1, 0}, {0, share, 0, 1}, {1, share, 0, 1}}) {
      const Vector2d along = (at(s + 0.01 * ds, t + 0.01 * dt) - at(s - 0.01 * ds, t - 0.01 * dt)).normalized();
      const Vector2d normal(-along.y(), along.x()), pixel = at(s, t);
      if (!insideImage(camera, pixel, reach + 2)) continue;
      offsets.push_back(edgeOffset(radiance, pixel, normal, reach));
    }
  }
  return offsets;
}

double average(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}

double largestSize(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

class Lenses : public testing::TestWithParam<bool> {};

TEST_P(Lenses, EdgesLieWhereTheyProject) {
  const Camera camera = smallCamera(GetParam());
  const LitScene lit = slantedRectangle();
  const cv::Mat radiance = renderRadiance(lit, makeRayTable(camera), std::vector<Pose>(5));
  const std::vector<double> offsets = edgeOffsets(camera, radiance, lit.scene.rectangles[1], Pose(), 4);
  ASSERT_GT(offsets.size(), 40U);
  EXPECT_LT(largestSize(offsets), 0.08);
  EXPECT_LT(std::abs(average(offsets)), 0.01);
}

TEST_P(Lenses, TexturesLieWhereTheyProject) {
  const Camera camera = smallCamera(GetParam());
  LitScene lit = slantedRectangle();
  SceneTexture texture;
  texture.levels.emplace_back(64, 100, CV_8U, cv::Scalar(40));
  texture.levels[0].colRange(50, 100).setTo(220);  // a step at s = 0.5
  lit.scene.textures.push_back(texture);
  lit.scene.rectangles[1].texture = 0;
  const cv::Mat radiance = renderRadiance(lit, makeRayTable(camera), std::vector<Pose>(5));
  const SceneRectangle& r = lit.scene.rectangles[1];
  const auto at = [&](double s, double t) { return project(camera, r.corner + s * r.side_s + t * r.side_t); };
  std::vector<double> offsets;
  for (double t = 0.15; t < 0.86; t += 0.02) {
    const Vector2d along = (at(0.5, t + 0.01) - at(0.5, t - 0.01)).normalized();
    offsets.push_back(edgeOffset(radiance, at(0.5, t), Vector2d(-along.y(), along.x()), 4));
  }
  EXPECT_LT(largestSize(offsets), 0.08);
  EXPECT_LT(std::abs(average(offsets)), 0.02);
}

INSTANTIATE_TEST_SUITE_P(PinholeAndFisheye, Lenses, testing::Bool());

TEST(SceneRenderer, BlurIsCentredOnTheMiddlePose) {
  const Camera camera = smallCamera(false);
  const LitScene lit = slantedRectangle();
  std::vector<Pose> poses(9);
  for (int i = 0; i < 9; ++i) {
    const double time = (i + 0.5) / 9 - 0.5;
    poses[static_cast<std::size_t>(i)].translation = time * Vector3d(0.08, 0.02, 0.01);
    poses[static_cast<std::size_t>(i)].rotation = rotationExp(time * Vector3d(0.01, -0.02, 0.02));
  }
  const RayTable rays = makeRayTable(camera);
  const cv::Mat blurred = renderRadiance(lit, rays, poses), sharp = renderRadiance(lit, rays, std::vector<Pose>(9));
  const std::vector<double> offsets = edgeOffsets(camera, blurred, lit.scene.rectangles[1], poses[4].inverse(), 8);
  ASSERT_GT(offsets.size(), 30U);
  EXPECT_LT(largestSize(offsets), 0.15);
  EXPECT_LT(std::abs(average(offsets)), 0.03);
  EXPECT_GT(cv::norm(blurred, sharp, cv::NORM_INF), 0.1);
}

TEST(SceneRenderer, RowsOfOnePoseAreOneImage) {
  const LitScene lit = slantedRectangle();
  const RayTable rays = makeRayTable(smallCamera(false));
  const std::vector<Pose> poses(5);
  const cv::Mat whole = renderRadiance(lit, rays, poses);
  const cv::Mat rows = renderRowByRow(lit, rays, [&](int) { return poses; });
  EXPECT_LT(cv::norm(whole, rows, cv::NORM_INF), 1e-5);
}

TEST(SceneRenderer, EveryRowIsSeenFromItsOwnPoses) {
  const Camera camera = smallCamera(true);
  const LitScene lit = slantedRectangle();
  const RayTable rays = makeRayTable(camera);
  const auto poses = [&](int row) {
    Pose pose;
    pose.translation = row / 120.0 * Vector3d(0.08, 0.05, 0.06);
    pose.rotation = rotationExp(row / 120.0 * Vector3d(0.03, -0.04, 0.05));
    return std::vector<Pose>(5, pose);
  };
  const cv::Mat rows = renderRowByRow(lit, rays, poses);
  for (const int row : {0, 1, 59, 118, 119}) {
    const cv::Mat whole = renderRadiance(lit, rays, poses(row));
    EXPECT_LT(cv::norm(whole.row(row), rows.row(row), cv::NORM_INF), 1e-5) << row;
  }
}

TEST(SceneRenderer, TheNearerSurfaceIsSeen) {
  LitScene lit;
  add(lit, rectangle({-20, 20, 3}, {40, 0, 0}, {0, -40, 0}, 0.2));
  add(lit, rectangle({-20, 20, 2}, {20, 0, 0}, {0, -40, 0}, 0.6));
  add(lit, rectangle({-20, 20, 4}, {40, 0, 0}, {0, -40, 0}, 0.9));
  const Camera camera = smallCamera(false);
  const cv::Mat radiance = renderRadiance(lit, makeRayTable(camera), std::vector<Pose>(1));
  for (int y = 0; y < camera.height; ++y) {
    EXPECT_NEAR(radiance.at<float>(y, 40), 0.6, 1e-5);
    EXPECT_NEAR(radiance.at<float>(y, 120), 0.2, 1e-5);
  }
}

TEST(SceneRenderer, BacksAreNotSeen) {
  LitScene lit;
  add(lit, rectangle({-20, 20, 3}, {40, 0, 0}, {0, -40, 0}, 0.2));
  add(lit, rectangle({-20, 20, 2}, {0, -40, 0}, {40, 0, 0}, 0.6));
  const cv::Mat radiance = renderRadiance(lit, makeRayTable(smallCamera(false)), std::vector<Pose>(3));
  double least = 0, most = 0;
  cv::minMaxLoc(radiance, &least, &most);
  EXPECT_NEAR(least, 0.2, 1e-5);
  EXPECT_NEAR(most, 0.2, 1e-5);
}

TEST(SceneRenderer, TheMeterAgreesWithTheImage) {
  const Camera camera = smallCamera(false);
  const LitScene lit = slantedRectangle();
  const RayTable rays = makeRayTable(camera);
  const cv::Mat radiance = renderRadiance(lit, rays, std::vector<Pose>(5));
  EXPECT_NEAR(meterRadiance(lit, rays, Pose()), cv::mean(radiance)[0], 0.02);
}

TEST(SceneRays, RefuseADistortionThatFoldsTheImage) {
  Camera camera = smallCamera(false);
  camera.distortion = {-0.9, 0, 0, 0, 0};
  EXPECT_THROW(makeRayTable(camera), InputError);
}

TEST(SceneVisibility, BoxesAgreeWithSingleRays) {
  const LitScene lit = slantedRectangle();
  const std::vector<SeenRectangle> seen = seenFrom(lit.scene, Pose());
  std::vector<const SeenRectangle*> all, hits;
  for (const SeenRectangle& r : seen) all.push_back(&r);
  int alone_count = 0;
  for (float u = -0.7F; u < 0.7F; u += 0.1F) {
    for (float v = -0.5F; v < 0.5F; v += 0.1F) {
      const bool alone = findFirstHits(all, {u, v, 0.03F, 0.03F}, hits);
      alone_count += alone ? 1 : 0;
      for (const float du : {-0.029F, 0.0F, 0.029F}) {
        for (const float dv : {-0.029F, 0.0F, 0.029F}) {
          const SeenRectangle* hit = firstHit(seen, u + du, v + dv);
          ASSERT_NE(hit, nullptr);
          EXPECT_NE(std::find(hits.begin(), hits.end(), hit), hits.end());
          EXPECT_TRUE(!alone || hit == hits.front());
        }
      }
    }
  }
  EXPECT_GT(alone_count, 50);
}

}  // namespace
}  // namespace edgeslam
