// The map's scale by the wheels, from simulated drives; refused where they cannot tell.
#include "mapping/wheel_scale_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mapping/wheel_terms.h"

namespace edgeslam {
namespace {

const Pose body_T_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.1, 0.02, 0.3}};
const WheelOptions wheels{body_T_camera, false};
constexpr double metres_a_unit = 1.7;

struct Drive {
  double way_m = 0.05, turn_rad = 0.02;  // from keyframe to keyframe
  int keyframes = 20;
  double place_sigma = 0.0005;  // of keyframes [map units]
  int slip_at = -1;             // there the wheels say half a metre more
};

// A map in a frame and a unit of its own.
Map mapOf(const Drive& drive) {
  std::mt19937 engine(3);  // NOLINT: the same in every run
  std::normal_distribution<double> normal;
  const Pose map_T_world{Eigen::Quaterniond(0.8, 0.3, -0.4, 0.33).normalized(), {1, 2, 3}};
  Pose body, wheel_body;
  double way_m = 0, turn_rad = 0;
  Map map;
  for (int k = 0; k < drive.keyframes; ++k) {
    Keyframe keyframe;
    keyframe.id = k;
    const Pose map_T_camera = map_T_world * body * body_T_camera;
    keyframe.world_T_camera = {map_T_camera.rotation, map_T_camera.translation / metres_a_unit};
    keyframe.world_T_camera.translation +=
        drive.place_sigma * Eigen::Vector3d(normal(engine), normal(engine), normal(engine));
    keyframe.wheels = {wheel_body, 0, way_m, turn_rad};
    map.keyframes.push_back(std::move(keyframe));
    const Pose step{rotationExp(drive.turn_rad * Eigen::Vector3d::UnitZ()), {drive.way_m, 0, 0}};
    const double slip_m = k == drive.slip_at ? 0.5 : 0;
    body = body * step;
    wheel_body = wheel_body * Pose{step.rotation, step.translation + Eigen::Vector3d(slip_m, 0, 0)};
    way_m += drive.way_m + slip_m;
    turn_rad += std::abs(drive.turn_rad);
  }
  return map;
}

TEST(WheelScaleEstimate, TellsTheScaleOfADrive) {
  for (const double turn_rad : {0.0, 0.02, 0.1}) {
    Drive drive;
    drive.turn_rad = turn_rad;
    const WheelScaleEstimate estimate = estimateWheelScale(wheels, {}, mapOf(drive), 0);
    ASSERT_TRUE(estimate.scale.is_known) << estimate.lacking;
    EXPECT_TRUE(estimate.lacking.empty());
    EXPECT_NEAR(estimate.scale.metres_a_unit, metres_a_unit, 3 * estimate.scale.sigma * metres_a_unit);
    EXPECT_LT(estimate.scale.sigma, 0.06);
  }
}

TEST(WheelScaleEstimate, LeavesOutWhereTheWheelsSlipped) {
  Drive drive;
  drive.slip_at = 9;
  const WheelScaleEstimate estimate = estimateWheelScale(wheels, {}, mapOf(drive), 0);
  ASSERT_TRUE(estimate.scale.is_known) << estimate.lacking;
  EXPECT_NEAR(estimate.scale.metres_a_unit, metres_a_unit, 0.05 * metres_a_unit);
}

TEST(WheelScaleEstimate, IsRefusedWhereTheMotionCannotTell) {
  Drive standing;
  standing.way_m = standing.turn_rad = 0;
  EXPECT_NE(estimateWheelScale(wheels, {}, mapOf(standing), 0).lacking.find("0 of "), std::string::npos);
  Drive young;
  young.keyframes = 3;
  EXPECT_FALSE(estimateWheelScale(wheels, {}, mapOf(young), 0).scale.is_known);
  Map without = mapOf({});
  for (Keyframe& keyframe : without.keyframes) keyframe.wheels = {};
  EXPECT_FALSE(estimateWheelScale(wheels, {}, without, 0).scale.is_known);
  EXPECT_FALSE(estimateWheelScale(wheels, {}, mapOf({}), 1).scale.is_known) << "a world without keyframes";
}

TEST(WheelScaleEstimate, SaysThatTheCameraIsMountedOtherwise) {
  const WheelOptions wrong{{Eigen::Quaterniond::Identity(), {0.1, 0.02, 0.3}}, false};
  const WheelScaleEstimate estimate = estimateWheelScale(wrong, {}, mapOf({}), 0);
  EXPECT_FALSE(estimate.scale.is_known);
  EXPECT_NE(estimate.lacking.find("body_T_camera"), std::string::npos) << estimate.lacking;
}

TEST(WheelTerms, LeaveOutWhereTheWheelsSlipped) {
  Drive drive;
  drive.slip_at = 9;
  const Map map = mapOf(drive);
  const WheelScale scale{true, metres_a_unit, 0.02};
  for (int k = 0; k + 1 < drive.keyframes; ++k) {
    EXPECT_EQ(motionToNext(wheels, scale, map.keyframes[k], map.keyframes[k + 1]).has_value(), k != 9) << k;
  }
  BundleProblem problem;
  int asked_from = 0;
  std::vector<KeyframeId> free{8, 9, 10};
  addWheelTerms(
      wheels, scale, std::nullopt, map, free, [&](KeyframeId id) { return ++asked_from, id; }, problem);
  EXPECT_EQ(problem.turns.size(), 3U) << "7-8, 8-9, 10-11";
  EXPECT_EQ(problem.ways.size(), 3U);
  BundleProblem of_turns;
  addWheelTerms(
      wheels, {}, std::nullopt, map, free, [&](KeyframeId id) { return id; }, of_turns);
  EXPECT_EQ(of_turns.turns.size(), 4U) << "without a scale nothing is said of ways";
  EXPECT_TRUE(of_turns.ways.empty());
  EXPECT_EQ(asked_from, 6);
}

// What the gyroscope says of a turn takes the place of the wheels' claim, and finds what slipped.
TEST(WheelTerms, CountLessWhereAGyroscopeTellsTheTurnAndNotWhereItContradictsIt) {
  Map map = mapOf(Drive());
  const GyroscopeBeside gyroscope{body_T_camera.rotation.conjugate(), {}};  // a unit that sits as the body does
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.id == 0) continue;
    keyframe.inertia.from = keyframe.id - 1;
    const double slipped = keyframe.id == 9 ? 0.1 : 0;
    keyframe.inertia.motion.rotation = rotationExp((Drive().turn_rad + slipped) * Eigen::Vector3d::UnitZ());
  }
  const WheelScale scale{true, metres_a_unit, 0.02};
  const std::vector<KeyframeId> free{8, 9, 10};
  const auto problemWith = [&](const std::optional<GyroscopeBeside>& beside) {
    BundleProblem problem;
    addWheelTerms(
        wheels, scale, beside, map, free, [](KeyframeId id) { return static_cast<int>(id); }, problem);
    return problem;
  };
  const BundleProblem with = problemWith(gyroscope), without = problemWith(std::nullopt);
  EXPECT_EQ(without.turns.size(), 4U);
  ASSERT_EQ(with.turns.size(), 3U) << "7-8, 9-10, 10-11";
  ASSERT_EQ(with.ways.size(), 3U);
  EXPECT_LT(with.turns[0].whitening.norm(), 0.5 * without.turns[0].whitening.norm());
  EXPECT_EQ(with.ways[0].whitening, without.ways[0].whitening);
  EXPECT_EQ(with.ways[0].metres_a_unit, metres_a_unit);
}

}  // namespace
}  // namespace edgeslam
