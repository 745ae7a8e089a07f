#include "drivers/ros2/ros_covariance.h"

#include <gtest/gtest.h>

#include "drivers/lcm/body_pose.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

// Errors of small poses about the truth, as ROS tells them: of the position, and about the axes of the parent.
Vector6d rosError(const Pose& truth, const Pose& measured) {
  Vector6d error;
  error << measured.translation - truth.translation, rotationLog(measured.rotation * truth.rotation.conjugate());
  return error;
}

Matrix6d sampledRosCovariance(const Pose& truth, const Matrix6d& covariance, Random& random, int samples) {
  const Matrix6d root = covariance.llt().matrixL();
  Matrix6d sum = Matrix6d::Zero();
  for (int i = 0; i < samples; ++i) {
    Vector6d normal;
    for (int k = 0; k < 6; ++k) normal(k) = random.normal(1);
    const Vector6d error = rosError(truth, retract(truth, root * normal));
    sum += error * error.transpose();
  }
  return sum / samples;
}

TEST(RosCovariance, IsThatOfSampledPoses) {
  Random random(5);
  for (int i = 0; i < 5; ++i) {
    const Pose truth = randomPose(random);
    const Matrix6d covariance = randomCovariance(random);
    const Matrix6d sampled = sampledRosCovariance(truth, covariance, random, 40000);
    const Matrix6d told = inParent(covariance, truth.rotation);
    const Vector6d sigma = told.diagonal().cwiseSqrt();
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        EXPECT_NEAR(sampled(row, column), told(row, column), 0.03 * sigma(row) * sigma(column)) << row << column;
      }
    }
  }
}

TEST(RosCovariance, OfABodyThatIsNotTurnedIsTheSame) {
  Random random(6);
  const Matrix6d covariance = randomCovariance(random);
  EXPECT_TRUE(inParent(covariance, Eigen::Quaterniond::Identity()).isApprox(covariance, 1e-12));
}

TEST(RosCovariance, OfAForwardErrorIsAlongTheWayThatTheBodyLooks) {
  Matrix6d forward = Matrix6d::Zero();
  forward(0, 0) = 4;
  const Eigen::Quaterniond left(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const Matrix6d in_parent = inParent(forward, left);
  EXPECT_NEAR(in_parent(1, 1), 4, 1e-12) << "it looks along y";
  EXPECT_NEAR(in_parent(0, 0), 0, 1e-12);
}

TEST(RosCovariance, GoesOutRowByRow) {
  Matrix6d numbered;
  for (int i = 0; i < 36; ++i) numbered(i / 6, i % 6) = i;
  const RosCovariance rows = rosCovariance(numbered);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(rows[static_cast<std::size_t>(i)], i);
}

TEST(RosCovariance, OfTheScaleIsAlongThePosition) {
  Random random(7);
  const Eigen::Vector3d position = random.vector(3);
  const Matrix6d covariance = randomCovariance(random);
  const Matrix6d more = withScaleError(covariance, position, 0.1) - covariance;
  EXPECT_TRUE((more.topLeftCorner<3, 3>()).isApprox(0.01 * position * position.transpose(), 1e-9));
  EXPECT_NEAR(more.rightCols<3>().norm(), 0, 1e-15);
}

TEST(RosCovariance, OfAPositionThatIsNotKnownLeavesTheRotationAlone) {
  Random random(8);
  const Matrix6d covariance = randomCovariance(random), without = withoutPosition(covariance);
  EXPECT_EQ((without.bottomRightCorner<3, 3>()), (covariance.bottomRightCorner<3, 3>()));
  EXPECT_EQ((without.topLeftCorner<3, 3>()), unknown_variance * Eigen::Matrix3d::Identity());
  EXPECT_EQ((without.topRightCorner<3, 3>()), Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace edgeslam
