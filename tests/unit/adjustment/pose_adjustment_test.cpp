// P16: a camera's pose adjusted to points of known depth, and its covariance.
#include "adjustment/pose_adjustment.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <limits>

#include "synthetic_scene.h"

namespace edgeslam::test {
namespace {

struct Trial {
  Camera camera;
  Pose truth;
  PoseObservations observations;
};

struct TrialOptions {
  int count = 200;
  double sigma_normal = 0.5;
  double sigma_tangent = 0.5;
  double noise = 1;      // times the sigmas
  double spread = M_PI;  // of the normals' angles [rad], around 0
  CameraModel model = CameraModel::pinhole_radial_tangential;
  bool distorted = true;
};

Trial makeTrial(Random& random, const TrialOptions& options) {
  Trial trial;
  trial.camera = testCamera(options.model);
  if (!options.distorted) trial.camera.distortion.fill(0);
  trial.truth = randomPose(random, 2, 1);
  for (int i = 0; i < options.count; ++i) {
    const Eigen::Vector2d pixel = randomPixel(random, trial.camera);
    PoseObservation o;
    o.point = trial.truth * (bearing(trial.camera, pixel) * uniform(random, 1, 6));
    o.measurement = measure(random, pixel, uniform(random, -options.spread, options.spread), options.sigma_normal,
                            options.sigma_tangent, options.noise);
    trial.observations.push_back(o);
  }
  return trial;
}

// The right-hand update that takes the truth to the estimate.
Vector6d poseError(const Pose& estimate, const Pose& truth) {
  const Pose difference = truth.inverse() * estimate;
  Vector6d error;
  error << difference.translation, rotationLog(difference.rotation);
  return error;
}

double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }

class PoseAdjustmentOfModel : public testing::TestWithParam<CameraModel> {};

TEST_P(PoseAdjustmentOfModel, RecoversExactPoseFromPerturbedStart) {
  Random random(1);
  for (int run = 0; run < 50; ++run) {
    TrialOptions options;
    options.noise = 0;
    options.model = GetParam();
    const Trial trial = makeTrial(random, options);
    const Pose start = perturbed(random, trial.truth, 0.1, 5 * M_PI / 180);
    const PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
    ASSERT_TRUE(result.converged);
    EXPECT_LT(distance(result.world_T_camera, trial.truth), 1e-6);
    EXPECT_LT(rotationAngle(result.world_T_camera.rotation, trial.truth.rotation), 1e-6);
    EXPECT_EQ(result.inlier_count, 200);
  }
}

TEST_P(PoseAdjustmentOfModel, EdgesOfEveryDirectionRecoverThePose) {
  Random random(2);
  for (int run = 0; run < 50; ++run) {
    TrialOptions options;
    options.sigma_tangent = 1000;
    options.model = GetParam();
    const Trial trial = makeTrial(random, options);
    const Pose start = perturbed(random, trial.truth, 0.1, 5 * M_PI / 180);
    const PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
    ASSERT_TRUE(result.converged);
    EXPECT_LT(distance(result.world_T_camera, trial.truth), 0.03);
    EXPECT_LT(rotationAngle(result.world_T_camera.rotation, trial.truth.rotation), 0.01);
  }
}

// A camera that moves as before sees each point from where it is as it reads the point's row.
TEST_P(PoseAdjustmentOfModel, RowsReadOneAfterAnotherRecoverThePoseAndTheMotion) {
  Random random(21);
  for (int run = 0; run < 50; ++run) {
    TrialOptions options;
    options.noise = 0;
    options.model = GetParam();
    Trial trial = makeTrial(random, options);
    trial.camera.readout_s = run % 2 == 0 ? 0.024 : -0.024;
    Twist twist;
    twist << uniformVector(random, 0.5), uniformVector(random, 0.5);
    for (PoseObservation& o : trial.observations) {
      const Eigen::Vector2d& pixel = o.measurement.pixel;
      o.point = trial.truth * rowPose(trial.camera, twist, pixel.y()) *
                (bearing(trial.camera, pixel) * uniform(random, 1, 6));
    }
    RowMotion motion;
    motion.seconds = 1.0 / 30;
    motion.world_T_before = trial.truth * movedFor(twist, motion.seconds).inverse();
    motion.before = twistBetween(motion.world_T_before, trial.truth, motion.seconds);
    motion.is_known_from_before = run % 3 == 0;
    const Pose start = perturbed(random, trial.truth, 0.02, 0.02);
    const PoseResult result =
        adjustPose(trial.camera, start, trial.observations, {}, std::pmr::get_default_resource(), motion);
    ASSERT_TRUE(result.converged);
    EXPECT_LT(distance(result.world_T_camera, trial.truth), 1e-3);
    EXPECT_LT(rotationAngle(result.world_T_camera.rotation, trial.truth.rotation), 1e-3);
    EXPECT_LT((result.twist - twist).norm(), 0.05);
    EXPECT_EQ(result.inlier_count, 200);
    Camera global = trial.camera;
    global.readout_s = 0;
    EXPECT_GT(adjustPose(global, start, trial.observations, {}).rms, 20 * result.rms);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, PoseAdjustmentOfModel,
                         testing::Values(CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt));

TEST(PoseAdjustment, RecoversWithThirtyPercentOutliers) {
  Random random(3);
  for (int run = 0; run < 100; ++run) {
    Trial trial = makeTrial(random, {});
    std::vector<char> is_outlier(trial.observations.size(), 0);
    for (std::size_t i = 0; i < trial.observations.size(); ++i) {
      if (uniform(random, 0, 1) > 0.3) continue;
      const Eigen::Vector2d truth = trial.observations[i].measurement.pixel;
      do {
        trial.observations[i].measurement.pixel = randomPixel(random, trial.camera);
      } while ((trial.observations[i].measurement.pixel - truth).norm() < 10);
      is_outlier[i] = 1;
    }
    const Pose start = perturbed(random, trial.truth, 0.1, 5 * M_PI / 180);
    PoseOptions options;
    options.iterations = 20;
    const PoseResult result = adjustPose(trial.camera, start, trial.observations, options);
    ASSERT_TRUE(result.converged) << "run " << run;
    EXPECT_LT(distance(result.world_T_camera, trial.truth), 0.02) << "run " << run;
    EXPECT_LT(rotationAngle(result.world_T_camera.rotation, trial.truth.rotation), 0.005) << "run " << run;
    int taken = 0;
    for (std::size_t i = 0; i < is_outlier.size(); ++i) taken += is_outlier[i] && result.inliers[i];
    EXPECT_EQ(taken, 0) << "run " << run;
    EXPECT_GT(result.inlier_count, 110) << "run " << run;
  }
}

TEST(PoseAdjustment, ParallelEdgesAreNotTakenForAPose) {
  Random random(4);
  for (int run = 0; run < 30; ++run) {
    TrialOptions options;
    options.sigma_tangent = 1000;
    options.spread = 0;         // every normal along the image's x: nothing tells of a move along the camera's y,
    options.distorted = false;  // except, a little, the distortion
    const Trial trial = makeTrial(random, options);
    const Pose start = perturbed(random, trial.truth, 0.02, 0.01);
    const PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
    if (!result.converged) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(result.covariance);
    const double largest = std::sqrt(eigen.eigenvalues()(5));
    EXPECT_GT(largest, 0.1);
    // What the covariance claims holds for the error.
    const Vector6d error = poseError(result.world_T_camera, trial.truth);
    EXPECT_LT(error.dot(result.covariance.ldlt().solve(error)), 40);
  }
}

TEST(PoseAdjustment, CovarianceIsHonest) {
  for (const double sigma_tangent : {0.5, 1000.0}) {
    Random random(5);
    constexpr int trials = 300;
    double sum = 0;
    for (int run = 0; run < trials; ++run) {
      TrialOptions options;
      options.sigma_tangent = sigma_tangent;
      const Trial trial = makeTrial(random, options);
      const Pose start = perturbed(random, trial.truth, 0.05, 0.03);
      const PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
      ASSERT_TRUE(result.converged);
      const Vector6d error = poseError(result.world_T_camera, trial.truth);
      sum += error.dot(result.covariance.ldlt().solve(error)) / 6;
    }
    RecordProperty("nees_sigma_tangent_" + std::to_string(static_cast<int>(sigma_tangent)),
                   std::to_string(sum / trials));
    EXPECT_GT(sum / trials, 0.8) << sigma_tangent;
    EXPECT_LT(sum / trials, 1.3) << sigma_tangent;
  }
}

// Along the edge, across it and along the depth's direction each has its own standard deviation.
TEST(PoseAdjustment, InformationIsThatOfTheMeasurementsCovariance) {
  Random random(8);
  for (int run = 0; run < 50; ++run) {
    Trial trial = makeTrial(random, {/*count=*/1, /*sigma_normal=*/0.4, /*sigma_tangent=*/5});
    PoseObservation& o = trial.observations.front();
    o.depth_sigma_px = uniform(random, 0.1, 3);
    const double angle = uniform(random, -M_PI, M_PI);
    o.depth_direction = {std::cos(angle), std::sin(angle)};
    Eigen::Matrix<double, 2, 6> pixel_by_pose;
    for (int i = 0; i < 6; ++i) {
      Vector6d step = Vector6d::Zero();
      step[i] = 1e-6;
      const auto seen = [&](const Vector6d& by) {
        return project(trial.camera, retract(trial.truth, by).inverse() * o.point);
      };
      pixel_by_pose.col(i) = (seen(step) - seen(-step)) / 2e-6;
    }
    const Eigen::Vector2d across = o.measurement.normal, along(-across.y(), across.x());
    const Eigen::Matrix2d covariance =
        0.4 * 0.4 * across * across.transpose() + 25 * along * along.transpose() +
        o.depth_sigma_px * o.depth_sigma_px * o.depth_direction * o.depth_direction.transpose();
    const Matrix6d expected = pixel_by_pose.transpose() * covariance.inverse() * pixel_by_pose;
    const Matrix6d information = poseInformation(trial.camera, trial.truth, trial.observations);
    EXPECT_LT((information - expected).norm(), 1e-4 * expected.norm()) << run;
  }
}

TEST(PoseAdjustment, EquationsHaveTheCostsDerivatives) {
  Random random(9);
  TrialOptions noisy;
  noisy.noise = 2;  // some beyond Huber's threshold
  for (const double readout_s : {0.0, 0.02}) {
    Trial trial = makeTrial(random, noisy);
    trial.camera.readout_s = readout_s;
    Twist twist;
    twist << 0.3, -0.2, 0.1, 0.4, 0.2, -0.3;
    const auto equationsAt = [&](const Vector6d& update) {
      return poseEquations(trial.camera, {retract(trial.truth, update), twist}, trial.observations, {});
    };
    const PoseEquations equations = equationsAt(Vector6d::Zero());
    constexpr double step = 1e-6;
    for (int axis = 0; axis < 6; ++axis) {
      const Vector6d moved = step * Vector6d::Unit(axis);
      const double numeric = (equationsAt(moved).cost - equationsAt(-moved).cost) / (2 * step);
      const double scale = std::sqrt(equations.cost * equations.information(axis, axis));
      EXPECT_NEAR(numeric, 2 * equations.gradient[axis], 1e-3 * scale) << axis;
    }
    EXPECT_GT(equations.information.diagonal().minCoeff(), 0);
  }
}

TEST(PoseAdjustment, CovarianceCountsUncertainDepths) {
  Random random(6);
  constexpr int trials = 300;
  double sum = 0, squares = 0, squares_ignorant = 0;
  for (int run = 0; run < trials; ++run) {
    Trial trial = makeTrial(random, {});
    for (PoseObservation& o : trial.observations) {
      o.depth_sigma_px = uniform(random, 0, 3);
      const double angle = uniform(random, -M_PI, M_PI);
      o.depth_direction = {std::cos(angle), std::sin(angle)};
      o.measurement.pixel += gaussian(random, o.depth_sigma_px) * o.depth_direction;
    }
    const Pose start = perturbed(random, trial.truth, 0.05, 0.03);
    PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
    ASSERT_TRUE(result.converged);
    const Vector6d error = poseError(result.world_T_camera, trial.truth);
    sum += error.dot(result.covariance.ldlt().solve(error)) / 6;
    squares += error.squaredNorm();
    for (PoseObservation& o : trial.observations) o.depth_sigma_px = 0;
    result = adjustPose(trial.camera, start, trial.observations, {});
    squares_ignorant += poseError(result.world_T_camera, trial.truth).squaredNorm();
  }
  EXPECT_GT(sum / trials, 0.8);
  EXPECT_LT(sum / trials, 1.3);
  EXPECT_LT(squares, squares_ignorant);
}

TEST(PoseAdjustment, CovarianceGrowsWithWhatTheSigmasDoNotExplain) {
  Random random(7);
  TrialOptions calm, rough;
  rough.noise = 1.8;
  PoseOptions options;
  options.outlier = 10;
  const Trial calm_trial = makeTrial(random, calm);
  random.seed(7);
  const Trial rough_trial = makeTrial(random, rough);
  const PoseResult calm_result = adjustPose(calm_trial.camera, calm_trial.truth, calm_trial.observations, options);
  const PoseResult rough_result = adjustPose(rough_trial.camera, rough_trial.truth, rough_trial.observations, options);
  ASSERT_TRUE(calm_result.converged && rough_result.converged);
  EXPECT_GT(rough_result.covariance.trace(), 1.8 * calm_result.covariance.trace());
  EXPECT_GT(rough_result.rms, calm_result.rms);
}

TEST(PoseAdjustment, TooFewObservationsLeaveThePose) {
  Random random(8);
  TrialOptions few;
  few.count = 9;
  const Trial trial = makeTrial(random, few);
  const Pose start = perturbed(random, trial.truth, 0.1, 0.05);
  const PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(sameBytes(result.world_T_camera, start));
  EXPECT_EQ(result.inliers.size(), 9u);
  EXPECT_FALSE(adjustPose(trial.camera, start, {}, {}).converged);
}

TEST(PoseAdjustment, TooFewInliersLeaveThePose) {
  Random random(9);
  Trial trial = makeTrial(random, {});
  for (PoseObservation& o : trial.observations) o.measurement.pixel = randomPixel(random, trial.camera);
  PoseOptions options;
  options.fewest = 30;
  const Pose start = trial.truth;
  const PoseResult result = adjustPose(trial.camera, start, trial.observations, options);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(sameBytes(result.world_T_camera, start));
}

TEST(PoseAdjustment, PointsBehindTheCameraAreOutliers) {
  Random random(10);
  Trial trial = makeTrial(random, {});
  for (int i = 0; i < 40; ++i) {
    PoseObservation& o = trial.observations[static_cast<std::size_t>(i)];
    o.point = trial.truth * (-(trial.truth.inverse() * o.point));
  }
  const Pose start = perturbed(random, trial.truth, 0.05, 0.03);
  const PoseResult result = adjustPose(trial.camera, start, trial.observations, {});
  ASSERT_TRUE(result.converged);
  for (std::size_t i = 0; i < 40; ++i) EXPECT_FALSE(result.inliers[i]);
  EXPECT_LT(distance(result.world_T_camera, trial.truth), 0.02);
}

TEST(PoseAdjustment, ValuesThatAreNoNumbersAreOutliers) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Random random(11);
  Trial trial = makeTrial(random, {});
  trial.observations[0].measurement.pixel.x() = nan;
  trial.observations[1].point.y() = nan;
  trial.observations[2].point.z() = kInfinity;
  trial.observations[3].measurement.sigma_normal = 0;
  trial.observations[4].measurement.normal.setConstant(nan);
  trial.observations[5].depth_sigma_px = nan;
  trial.observations[6].depth_sigma_px = kInfinity;
  trial.observations[7].point = trial.truth.translation;
  const PoseResult result = adjustPose(trial.camera, trial.truth, trial.observations, {});
  ASSERT_TRUE(result.converged);
  for (const std::size_t i : {0u, 1u, 2u, 3u, 4u, 6u, 7u}) EXPECT_FALSE(result.inliers[i]) << i;
  EXPECT_LT(distance(result.world_T_camera, trial.truth), 0.02);
  EXPECT_TRUE(result.covariance.allFinite());

  Pose start = trial.truth;
  start.translation.x() = nan;
  EXPECT_FALSE(adjustPose(trial.camera, start, trial.observations, {}).converged);
}

PosePrior priorOf(const Pose& pose, double sigma_m, double sigma_rad) {
  PosePrior prior{pose};
  prior.information.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / (sigma_m * sigma_m);
  prior.information.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() / (sigma_rad * sigma_rad);
  return prior;
}

// A weak one changes nothing, a strong one decides; either is in the covariance.
TEST(PoseAdjustment, APriorOfThePositionCounts) {
  Random random(14);
  const Trial trial = makeTrial(random, {});
  const PoseResult without = adjustPose(trial.camera, trial.truth, trial.observations, {});
  ASSERT_TRUE(without.converged);
  const auto with = [&](const Eigen::Vector3d& off, double sigma) {
    const PosePrior prior = priorOf({trial.truth.rotation, trial.truth.translation + off}, sigma, INFINITY);
    PoseResult result =
        adjustPose(trial.camera, trial.truth, trial.observations, {}, std::pmr::get_default_resource(), {}, prior);
    EXPECT_TRUE(result.converged);
    return result;
  };
  const Eigen::Vector3d off(0.02, -0.03, 0.01);
  const PoseResult weak = with(off, 1e3), strong = with(off, 1e-7);
  EXPECT_LT(distance(weak.world_T_camera, without.world_T_camera), 1e-6);
  EXPECT_LT((strong.world_T_camera.translation - trial.truth.translation - off).norm(), 1e-5);
  const Matrix6d covariance = with(Eigen::Vector3d::Zero(), 1e-4).covariance;
  EXPECT_LT(covariance.diagonal().head<3>().maxCoeff(), 1e-8);
  for (const double sigma : {1e-3, 1e-2}) {
    EXPECT_LT(with(Eigen::Vector3d::Zero(), sigma).covariance.trace(), without.covariance.trace()) << sigma;
  }
}

TEST(PoseAdjustment, APriorOfTheRotationCountsLikewise) {
  Random random(16);
  const Trial trial = makeTrial(random, {});
  const Vector6d off = (Vector6d() << 0, 0, 0, 4e-4, -3e-4, 5e-4).finished();
  const auto with = [&](double sigma_rad) {
    const PosePrior prior = priorOf(retract(trial.truth, off), 1e3, sigma_rad);
    return adjustPose(trial.camera, trial.truth, trial.observations, {}, std::pmr::get_default_resource(), {}, prior);
  };
  const PoseResult strong = with(1e-8), weak = with(1e3);
  const PoseResult without = adjustPose(trial.camera, trial.truth, trial.observations, {});
  ASSERT_TRUE(strong.converged && weak.converged);
  EXPECT_LT((poseError(strong.world_T_camera, trial.truth) - off).tail<3>().norm(), 1e-6);
  EXPECT_LT(strong.covariance.diagonal().tail<3>().maxCoeff(), 1e-15);
  EXPECT_LT(poseError(weak.world_T_camera, without.world_T_camera).norm(), 1e-6);
}

TEST(PoseAdjustment, TellsWhereThePoseWouldBeWithoutThePrior) {
  Random random(19);
  const Trial trial = makeTrial(random, {});
  const PoseResult without = adjustPose(trial.camera, trial.truth, trial.observations, {});
  EXPECT_TRUE(without.without_prior.isZero(0));
  const Vector6d off = (Vector6d() << 2e-3, -1e-3, 1e-3, 4e-4, -3e-4, 5e-4).finished();
  for (const double sigma_rad : {1e-4, 1e-3}) {
    const PosePrior prior = priorOf(retract(trial.truth, off), 10 * sigma_rad, sigma_rad);
    const PoseResult with =
        adjustPose(trial.camera, trial.truth, trial.observations, {}, std::pmr::get_default_resource(), {}, prior);
    ASSERT_TRUE(with.converged);
    const double apart = poseError(with.world_T_camera, without.world_T_camera).norm();
    EXPECT_GT(apart, 1e-5) << "the prior counts";
    EXPECT_LT(poseError(retract(with.world_T_camera, with.without_prior), without.world_T_camera).norm(), 0.15 * apart)
        << sigma_rad;
  }
}

TEST(PoseAdjustment, DerivativesOfAPriorAreTheNumericOnes) {
  Random random(17);
  for (int run = 0; run < 10; ++run) {
    PosePrior prior{randomPose(random, 2, 1)};
    const Matrix6d root = Matrix6d::NullaryExpr([&](auto, auto) { return uniform(random, -1, 1); });
    prior.information = root * root.transpose();
    Vector6d away = Vector6d::NullaryExpr([&](auto) { return uniform(random, -0.5, 0.5); });
    const Pose pose = retract(prior.world_T_camera, away);
    const PoseEquations equations = priorEquations(prior, pose);
    constexpr double step = 1e-6;
    for (int axis = 0; axis < 6; ++axis) {
      const auto costAt = [&](double by) {
        return priorEquations(prior, retract(pose, by * Vector6d::Unit(axis))).cost;
      };
      EXPECT_NEAR((costAt(step) - costAt(-step)) / (2 * step), 2 * equations.gradient[axis], 1e-7) << axis;
    }
    // Its own covariance, where it is right.
    EXPECT_LT((priorEquations(prior, prior.world_T_camera).information - prior.information).norm(), 1e-12);
    EXPECT_EQ(priorEquations(prior, prior.world_T_camera).cost, 0);
  }
  EXPECT_EQ(priorEquations({}, randomPose(random, 2, 1)).cost, 0);
}

// Where the world becomes another, the same place and the same doubt.
TEST(PoseAdjustment, APriorMovesWithTheWorld) {
  Random random(18);
  const PosePrior prior = priorOf(randomPose(random, 2, 1), 0.02, 0.01);
  const Pose pose = retract(prior.world_T_camera, 0.03 * Vector6d::Ones());
  const Similarity new_S_old{1.7, randomPose(random, 3, 2).rotation, Eigen::Vector3d(0.3, -2, 1)};
  EXPECT_NEAR(priorEquations(moved(new_S_old, prior), moved(new_S_old, pose)).cost, priorEquations(prior, pose).cost,
              1e-9);
}

TEST(PoseAdjustment, OnePointSeenManyTimesIsNoPose) {
  Random random(12);
  TrialOptions options;
  options.noise = 0;
  Trial trial = makeTrial(random, options);
  for (PoseObservation& o : trial.observations) o = trial.observations[0];
  const PoseResult result = adjustPose(trial.camera, trial.truth, trial.observations, {});
  EXPECT_FALSE(result.converged);
}

TEST(PoseAdjustment, SameInputSameBytes) {
  Random random(13);
  TrialOptions options;
  options.sigma_tangent = 1000;
  const Trial trial = makeTrial(random, options);
  const Pose start = perturbed(random, trial.truth, 0.1, 0.08);
  const PoseResult first = adjustPose(trial.camera, start, trial.observations, {});
  const PoseResult second = adjustPose(trial.camera, start, trial.observations, {});
  EXPECT_TRUE(sameBytes(first.world_T_camera, second.world_T_camera));
  EXPECT_EQ(first.covariance, second.covariance);
}

}  // namespace
}  // namespace edgeslam::test
