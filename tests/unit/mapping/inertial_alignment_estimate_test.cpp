// How a map lies to the earth, from simulated motion; and refused where the motion cannot tell.
#include "mapping/inertial_alignment_estimate.h"

#include <gtest/gtest.h>

#include <random>

#include "inertia/inertial_history.h"
#include "unit/inertia/simulated_motion.h"

namespace edgeslam::test {
namespace {

const InertialBias true_bias{{0.02, -0.03, 0.01}, {0.12, -0.08, 0.15}};

struct SimulatedMap {
  InertialUnit unit;
  Map map;
  double metres_a_unit = 1.7;
  Eigen::Quaterniond map_R_world = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.33).normalized();
  Eigen::Vector3d gravity() const { return map_R_world * Eigen::Vector3d(0, 0, -standard_gravity); }
};

// Keyframes every `interval` seconds, with errors of their places and turns, in a frame and a unit of their own.
SimulatedMap simulatedMap(const SimulatedMotion& motion, double seconds, double interval, double place_sigma_m) {
  SimulatedMap made;
  made.unit.imu_T_camera = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.05, -0.02, 0.03}};
  std::mt19937 engine(7);  // NOLINT: the same in every run
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return Eigen::Vector3d(sigma * normal(engine), sigma * normal(engine), sigma * normal(engine));
  };
  InertialHistory history(made.unit);
  constexpr double rate_hz = 200;
  for (InertialSample sample : motion.measured(0, seconds + 0.1, rate_hz, true_bias)) {
    sample.rate += noise(made.unit.rate_noise * std::sqrt(rate_hz));
    sample.force += noise(made.unit.force_noise * std::sqrt(rate_hz));
    history.add(sample);
  }
  const Pose origin = motion.poseAt(0.05);
  std::int64_t before_ns = 0;
  for (int k = 0; k * interval + 0.05 < seconds; ++k) {
    const double t = k * interval + 0.05;
    const Pose world_T_camera = motion.poseAt(t) * made.unit.imu_T_camera;
    Keyframe keyframe;
    keyframe.id = k;
    keyframe.time_ns = std::llround(t * 1e9);
    keyframe.world_T_camera.rotation =
        made.map_R_world * world_T_camera.rotation * rotationExp(noise(place_sigma_m > 0 ? 5e-4 : 0));
    keyframe.world_T_camera.translation = made.map_R_world *
                                          (world_T_camera.translation - origin.translation + noise(place_sigma_m)) /
                                          made.metres_a_unit;
    if (k > 0) keyframe.inertia = {k - 1, *history.between(before_ns, keyframe.time_ns, {})};
    before_ns = keyframe.time_ns;
    made.map.keyframes.push_back(std::move(keyframe));
  }
  return made;
}

InertialAlignmentEstimate estimateOf(const SimulatedMap& made, const InertialAlignment& so_far = {},
                                     const WheelScale& wheels = {}) {
  return estimateInertialAlignment(made.unit, {}, made.map, 0, so_far, wheels);
}

TEST(InertialAlignmentEstimate, FindsScaleGravityAndBiases) {
  const SimulatedMap made = simulatedMap(SimulatedMotion(), 8, 0.35, 0.002);
  const InertialAlignmentEstimate estimate = estimateOf(made);
  ASSERT_EQ(estimate.lacking, "");
  const InertialAlignment& found = estimate.alignment;
  EXPECT_NEAR(found.metres_a_unit / made.metres_a_unit, 1, 0.01);
  EXPECT_NEAR(found.metres_a_unit / made.metres_a_unit, 1, 3 * found.scale_sigma);
  EXPECT_LT(std::acos(found.gravity.normalized().dot(made.gravity().normalized())), 0.01);
  EXPECT_NEAR(found.gravity.norm(), standard_gravity, 1e-9);
  EXPECT_LT((found.bias.rate - true_bias.rate).norm(), 2e-3);
  EXPECT_LT((found.bias.force - true_bias.force).norm(), 0.05);
  EXPECT_LT((found.bias.force - true_bias.force).cwiseAbs().maxCoeff(), 3.5 * found.force_bias_sigma);
}

TEST(InertialAlignmentEstimate, GoesOnFromWhatIsKnown) {
  const SimulatedMap made = simulatedMap(SimulatedMotion(), 8, 0.35, 0.002);
  const InertialAlignment known = estimateOf(made).alignment;
  const InertialAlignmentEstimate again = estimateOf(made, known);
  ASSERT_EQ(again.lacking, "");
  EXPECT_NEAR(again.alignment.metres_a_unit / made.metres_a_unit, 1, 0.01);
  EXPECT_LT(again.alignment.scale_sigma, known.scale_sigma);
}

TEST(InertialAlignmentEstimate, RefusesWhatTheMotionCannotTell) {
  SimulatedMotion still;
  still.swing_m = still.turn_rad = 0;
  still.velocity.setZero();
  EXPECT_NE(estimateOf(simulatedMap(still, 8, 0.35, 0.002)).lacking, "");
  SimulatedMotion steady = still;
  steady.velocity = {0.5, 0.2, 0};
  EXPECT_NE(estimateOf(simulatedMap(steady, 8, 0.35, 0.002)).lacking, "") << "the speed does not change";
  SimulatedMotion turning = still;
  turning.turn_rad = 0.6;
  EXPECT_NE(estimateOf(simulatedMap(turning, 8, 0.35, 0.002)).lacking, "") << "rotation only";
}

TEST(InertialAlignmentEstimate, WheelsTellTheScaleWhereTheMotionCannot) {
  SimulatedMotion steady;
  steady.swing_m = steady.turn_rad = 0;
  steady.velocity = {0.5, 0.2, 0};
  const SimulatedMap made = simulatedMap(steady, 8, 0.35, 0.002);
  const WheelScale wheels{true, 1.01 * made.metres_a_unit, 0.02};
  const InertialAlignmentEstimate estimate = estimateOf(made, {}, wheels);
  ASSERT_EQ(estimate.lacking, "");
  EXPECT_NEAR(estimate.alignment.metres_a_unit / wheels.metres_a_unit, 1, 0.005);
  EXPECT_LE(estimate.alignment.scale_sigma, 1.001 * wheels.sigma);
  EXPECT_LT(std::acos(estimate.alignment.gravity.normalized().dot(made.gravity().normalized())), 0.05);
}

TEST(InertialAlignmentEstimate, WheelsHoldTheScaleThatTheyKnow) {
  const SimulatedMap made = simulatedMap(SimulatedMotion(), 8, 0.35, 0.002);
  const WheelScale wheels{true, 1.02 * made.metres_a_unit, 0.03};
  const InertialAlignment first = estimateOf(made, {}, wheels).alignment;
  const InertialAlignment again = estimateOf(made, first, wheels).alignment;
  for (const InertialAlignment& found : {first, again}) {
    EXPECT_TRUE(found.is_known);
    EXPECT_NEAR(found.metres_a_unit / wheels.metres_a_unit, 1, 0.01);
    EXPECT_EQ(found.scale_sigma, wheels.sigma);
    EXPECT_LT(std::acos(found.gravity.normalized().dot(made.gravity().normalized())), 0.02);
  }
}

TEST(InertialAlignmentEstimate, WaitsForEnoughKeyframes) {
  EXPECT_NE(estimateOf(simulatedMap(SimulatedMotion(), 1.2, 0.35, 0.002)).lacking, "");
  EXPECT_NE(estimateInertialAlignment({}, {}, Map(), 0, {}, {}).lacking, "");
}

TEST(InertialAlignmentEstimate, TellsAGyroscopeWithWrongAxes) {
  SimulatedMap made = simulatedMap(SimulatedMotion(), 8, 0.35, 0.002);
  made.unit.imu_T_camera.rotation = made.unit.imu_T_camera.rotation * rotationExp({0, 0, M_PI / 2});
  const std::string lacking = estimateOf(made).lacking;
  EXPECT_NE(lacking.find("gyroscope contradicts"), std::string::npos) << lacking;
}

}  // namespace
}  // namespace edgeslam::test
