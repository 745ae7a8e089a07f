#include "simulator/inertial_simulation.h"

#include <gtest/gtest.h>

#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

SimulatedSequence sequenceOf(SceneKind scene) {
  SimulationOptions options;
  options.scene = scene;
  options.width = 160;
  options.height = 120;
  options.frames = 120;  // the corridor's robot brakes before its first corner
  return makeSequence(options);
}

class InertialSimulation : public testing::TestWithParam<SceneKind> {};

// What the unit felt, added up, is how the speed along the path changes; its bias is 0.1 m/s^2 an axis.
TEST_P(InertialSimulation, FeelsTheSpeedChange) {
  constexpr double part_s = 0.3, largest_bias = 0.4, half_step_s = 0.02;
  const SimulatedSequence sequence = sequenceOf(GetParam());
  const Pose camera_T_imu = simulatedUnit().imu_T_camera.inverse();
  const auto unitAt = [&](double time_s) { return poseAt(sequence.motion, time_s) * camera_T_imu; };
  const auto speedAt = [&](double time_s) -> Eigen::Vector3d {
    return (unitAt(time_s + half_step_s).translation - unitAt(time_s - half_step_s).translation) / (2 * half_step_s);
  };
  Eigen::Vector3d felt = Eigen::Vector3d::Zero();
  double begin_s = 0.1, before_s = begin_s, fastest_change = 0;
  int parts = 0;
  for (const InertialSample& sample : simulateInertia(sequence)) {
    const double time_s = 1e-9 * static_cast<double>(sample.time_ns - sequence.time(0));
    if (time_s <= begin_s) continue;
    const Eigen::Vector3d acceleration =
        unitAt(time_s).rotation * sample.force + Eigen::Vector3d(0, 0, -standard_gravity);
    felt += (time_s - before_s) * acceleration;
    before_s = time_s;
    if (time_s - begin_s < part_s) continue;
    const Eigen::Vector3d change = speedAt(time_s) - speedAt(begin_s);
    EXPECT_LT((felt - change).norm(), largest_bias * (time_s - begin_s)) << "from " << begin_s << " s on";
    fastest_change = std::max(fastest_change, change.norm());
    begin_s = time_s;
    felt.setZero();
    ++parts;
  }
  EXPECT_GT(parts, 10);
  EXPECT_GT(fastest_change, 0.05) << "something is there to be felt";
}

INSTANTIATE_TEST_SUITE_P(Scenes, InertialSimulation,
                         testing::Values(SceneKind::room, SceneKind::corridor, SceneKind::panels));

}  // namespace
}  // namespace edgeslam
