#include "simulator/hand_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulator/scene_visibility.h"

namespace edgeslam {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

struct Speeds {
  double metres = 0;   // [m/s]
  double degrees = 0;  // [degrees/s]
};

Speeds speedsAt(const CameraMotion& motion, double time_s) {
  constexpr double step_s = 1e-3;
  const Pose before = poseAt(motion, time_s - step_s), after = poseAt(motion, time_s + step_s);
  return {(after.translation - before.translation).norm() / (2 * step_s),
          rotationAngle(before.rotation, after.rotation) / (2 * step_s) / degree};
}

class Scenes : public testing::TestWithParam<SceneKind> {};

TEST_P(Scenes, MotionIsThatOfAHandOrARobot) {
  const CameraMotion motion = makeCameraMotion(GetParam(), 1, 7, 30);
  std::vector<double> metres, degrees;
  for (double time = 0.1; time < 29; time += 0.05) {
    const Speeds speeds = speedsAt(motion, time);
    metres.push_back(speeds.metres);
    degrees.push_back(speeds.degrees);
  }
  std::sort(metres.begin(), metres.end());
  std::sort(degrees.begin(), degrees.end());
  EXPECT_GT(metres[metres.size() / 2], 0.1);
  EXPECT_LT(metres[metres.size() / 2], 1.1);
  EXPECT_LT(metres.back(), 1.3);
  EXPECT_LT(degrees.back(), 60);
}

TEST_P(Scenes, VelocityIsContinuous) {
  CameraMotion motion = makeCameraMotion(GetParam(), 1, 7, 30);
  motion.still.push_back({5, 6});
  motion.still.push_back({15, 18});
  motion.turned.push_back({15, 18});
  for (double time = 0.1; time < 28; time += 0.01) {
    const Speeds now = speedsAt(motion, time), next = speedsAt(motion, time + 0.01);
    EXPECT_LT(std::abs(now.metres - next.metres), 0.1) << time;
    EXPECT_LT(std::abs(now.degrees - next.degrees), 12) << time;
  }
}

TEST_P(Scenes, CameraKeepsClearOfTheSceneAndSeesNoHole) {
  const Scene scene = makeScene(GetParam(), 1);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const CameraMotion motion = makeCameraMotion(GetParam(), 1, seed, 30);
    for (double time = 0; time < 29; time += 0.4) {
      const std::vector<SeenRectangle> seen = seenFrom(scene, poseAt(motion, time));
      for (float u = -0.7F; u < 0.71F; u += 0.1F) {
        for (float v = -0.5F; v < 0.51F; v += 0.1F) {
          const SeenRectangle* hit = firstHit(seen, u, v);
          ASSERT_NE(hit, nullptr) << "hole at " << u << " " << v << ", " << time << " s";
          EXPECT_GT(1 / hit->inverse_depth(u, v), 0.35F) << time;
        }
      }
    }
  }
}

TEST_P(Scenes, SeedsDiffer) {
  const Pose first = poseAt(makeCameraMotion(GetParam(), 1, 1, 5), 1),
             second = poseAt(makeCameraMotion(GetParam(), 1, 2, 5), 1);
  const double difference =
      (first.translation - second.translation).norm() + rotationAngle(first.rotation, second.rotation);
  EXPECT_GT(difference, 1e-3);
  EXPECT_LT(difference, 1.0);
}

TEST_P(Scenes, NothingMovesWhileHeldStill) {
  CameraMotion motion = makeCameraMotion(GetParam(), 1, 3, 10);
  motion.still.push_back({3, 4.5});
  const Pose held = poseAt(motion, 3);
  for (double time = 3; time <= 4.5; time += 0.1) {
    EXPECT_NEAR((poseAt(motion, time).translation - held.translation).norm(), 0, 1e-9);
    EXPECT_NEAR(rotationAngle(poseAt(motion, time).rotation, held.rotation), 0, 1e-6);
  }
  EXPECT_GT(speedsAt(motion, 2).metres + speedsAt(motion, 2).degrees, 0.1);
  EXPECT_GT(speedsAt(motion, 5.5).metres + speedsAt(motion, 5.5).degrees, 0.1);
}

TEST_P(Scenes, ShakingIsViolentAndEndsWhereItShould) {
  CameraMotion motion = makeCameraMotion(GetParam(), 1, 3, 10);
  const CameraMotion calm = motion;
  motion.shaken.push_back({3, 4});
  double fastest = 0;
  for (double time = 3; time < 4; time += 0.02) fastest = std::max(fastest, speedsAt(motion, time).degrees);
  EXPECT_GT(fastest, 90);
  EXPECT_LT(fastest, 500);
  for (const double time : {2.0, 2.99, 4.01, 5.0}) {
    EXPECT_EQ(poseAt(motion, time).translation, poseAt(calm, time).translation);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Scenes,
                         testing::Values(SceneKind::panels, SceneKind::panels_textured, SceneKind::room,
                                         SceneKind::corridor, SceneKind::corridor_tiled),
                         [](const auto& scene) { return sceneName(scene.param); });

TEST(CorridorMotion, ReturnsToItsStartAfterALap) {
  const CameraMotion motion = makeCameraMotion(SceneKind::corridor, 1, 5, 40);
  const double lap_s = lapTime(motion);
  const Pose start = poseAt(motion, 0), back = poseAt(motion, lap_s);
  EXPECT_LT((back.translation - start.translation).norm(), 0.02);
  EXPECT_LT(rotationAngle(back.rotation, start.rotation), 2 * degree);
  EXPECT_GT((poseAt(motion, lap_s / 2).translation - start.translation).norm(), 3);
}

TEST(CorridorMotion, TwiceTheSpeedHalvesTheLap) {
  const double lap_s = lapTime(makeCameraMotion(SceneKind::corridor, 1, 5, 0));
  EXPECT_NEAR(lapTime(makeCameraMotion(SceneKind::corridor, 2, 5, 0)), lap_s / 2, 0.01);
}

}  // namespace
}  // namespace edgeslam
