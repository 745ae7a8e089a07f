// The fit over turns: its derivatives, and whether it knows how well it knows.
#include "inertia/turn_fit.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

Vector7d changeBetween(const TurnParameters& from, const TurnParameters& to) {
  Vector7d change;
  change << rotationLog((from.imu_R_camera.conjugate() * to.imu_R_camera).normalized()), to.rate_bias - from.rate_bias,
      to.offset_s - from.offset_s;
  return change;
}

TurnParameters truth(const TurningCamera& camera) { return {camera.imu_R_camera, camera.rate_bias, camera.offset_s}; }

TurnError errorWith(const TurnParameters& parameters, const CameraTurn& seen,
                    const std::vector<InertialSample>& samples) {
  const std::int64_t offset_ns = std::llround(parameters.offset_s * 1e9);
  const auto felt =
      GyroscopeTurns(samples, parameters.rate_bias).between(seen.from_ns + offset_ns, seen.to_ns + offset_ns);
  EXPECT_TRUE(felt);
  return turnError(parameters, seen, *felt);
}

// Where errors are as large as they are at the start of a fit.
TEST(TurnFit, HasTheDerivativesOfItsErrors) {
  const TurningCamera camera;
  const std::vector<InertialSample> samples = camera.samples(1);
  Vector7d away, step;
  away << 0.05, -0.08, 0.03, 0.01, -0.01, 0.02, 0.004;
  step << 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-4;
  const TurnParameters start = changed(truth(camera), away);
  for (const CameraTurn& seen : {cameraTurns(camera.poses(1), 0.2)[100], cameraTurns(camera.poses(1), 0.6)[333]}) {
    const TurnError error = errorWith(start, seen, samples);
    for (int i = 0; i < 7; ++i) {
      const Vector7d change = step(i) * Vector7d::Unit(i);
      const Eigen::Vector3d numeric = (errorWith(changed(start, change), seen, samples).error -
                                       errorWith(changed(start, -change), seen, samples).error) /
                                      (2 * step(i));
      EXPECT_LT((numeric - error.by_parameters.col(i)).norm(), 0.01 * numeric.norm() + 1e-3) << i;
    }
  }
}

TEST(TurnFit, ErrsAsItsStandardDeviationsSay) {
  constexpr unsigned seeds = 20;
  Vector7d squares = Vector7d::Zero();
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const TurningCamera camera;
    Vector7d away;
    away << 0.03, -0.02, 0.03, 0.01, -0.01, 0.02, 0.004;
    const auto fit = fitTurns(cameraTurns(camera.poses(seed), 0.2), camera.samples(seed), changed(truth(camera), away),
                              camera.rate_walk);
    ASSERT_TRUE(fit);
    const Vector7d error = changeBetween(truth(camera), fit->parameters);
    const Vector7d multiples = error.cwiseQuotient(fit->covariance.diagonal().cwiseSqrt());
    EXPECT_LT(multiples.cwiseAbs().maxCoeff(), 3) << "seed " << seed << ": " << multiples.transpose();
    squares += multiples.cwiseAbs2() / seeds;
    EXPECT_NEAR(fit->error_rad, std::sqrt(2) * camera.pose_noise_rad, 0.1 * camera.pose_noise_rad);
    EXPECT_NEAR(fit->seconds, camera.seconds, 0.1);
  }
  // They allow for errors of poses that go with the motion, which these poses have not.
  EXPECT_LT(squares.maxCoeff(), 1.2) << squares.transpose();
  EXPECT_GT(squares.minCoeff(), 0.1) << squares.transpose();
}

TEST(TurnFit, AllowsForABiasThatWalks) {
  TurningCamera camera;
  camera.rate_walk = 1e-3;
  camera.pace = 0.2;  // as slowly as the bias
  camera.swing_rad = {0.5, 0.6, 0.4};
  double farthest = 0, farthest_without = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const std::vector<CameraTurn> turns = cameraTurns(camera.poses(seed), 0.2);
    const std::vector<InertialSample> samples = camera.samples(seed);
    const auto fit = fitTurns(turns, samples, truth(camera), camera.rate_walk);
    const auto without = fitTurns(turns, samples, truth(camera), 0);
    ASSERT_TRUE(fit && without);
    const Eigen::Vector3d error = changeBetween(truth(camera), fit->parameters).head<3>();
    const auto multiples = [&](const TurnFit& told) {
      return error.cwiseQuotient(told.covariance.diagonal().head<3>().cwiseSqrt()).cwiseAbs().maxCoeff();
    };
    farthest = std::max(farthest, multiples(*fit));
    farthest_without = std::max(farthest_without, multiples(*without));
  }
  EXPECT_LT(farthest, 3);
  EXPECT_GT(farthest_without, 1.2 * farthest) << "it makes a difference";
}

TEST(TurnFit, FramesThatWerePosedWronglyCountLittle) {
  const TurningCamera camera;
  std::vector<PosedCamera> poses = camera.poses(1);
  for (std::size_t i = 10; i < poses.size(); i += 50) {
    poses[i].world_T_camera.rotation = poses[i].world_T_camera.rotation * rotationExp({0.3, 0.1, -0.2});
  }
  const auto fit = fitTurns(cameraTurns(poses, 0.2), camera.samples(1), truth(camera), camera.rate_walk);
  ASSERT_TRUE(fit);
  const Vector7d error = changeBetween(truth(camera), fit->parameters);
  EXPECT_LT(error.head<3>().norm(), radians(0.1));
  EXPECT_LT(std::abs(error(6)), 3e-4);
}

TEST(TurnFit, OfTooFewTurnsIsNone) {
  TurningCamera camera;
  camera.seconds = 1.5;
  EXPECT_FALSE(fitTurns(cameraTurns(camera.poses(1), 0.2), camera.samples(1), truth(camera), camera.rate_walk));
}

}  // namespace
}  // namespace edgeslam::test
