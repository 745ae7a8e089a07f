// What is known of one camera, carried over to another that is known relative to it.
#include "geometry/uncertainty.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;

Eigen::Vector3d moved(const Vector7d& update, const Eigen::Vector3d& x) {
  return x + update.head<3>() + update.segment<3>(3).cross(x) + update(6) * x;
}

// An update of a moves what is known relative to a as the carried update, of b, moves it.
TEST(Uncertainty, CarriedIsTheSameMotionSeenFromTheOtherCamera) {
  test::Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose a_T_b = test::perturbed(random, Pose(), 2.0, 1.0);
    Vector7d of_a;
    for (int i = 0; i < 7; ++i) of_a(i) = test::uniform(random, -1, 1);
    const Matrix7d carried = carriedUncertainty(of_a * of_a.transpose(), a_T_b);
    // The update of b from three points' motion.
    Vector7d of_b;
    const auto motion_in_b = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return a_T_b.inverse() * moved(of_a, a_T_b * x) - x;
    };
    of_b.head<3>() = motion_in_b(Eigen::Vector3d::Zero());
    const Eigen::Vector3d by_x = motion_in_b(Eigen::Vector3d::UnitX()) - of_b.head<3>();
    const Eigen::Vector3d by_y = motion_in_b(Eigen::Vector3d::UnitY()) - of_b.head<3>();
    of_b.segment<3>(3) << by_y.z(), -by_x.z(), by_x.y();
    of_b(6) = by_x.x();
    EXPECT_LT((carried - of_b * of_b.transpose()).norm(), 1e-9 * (1 + carried.norm())) << trial;
  }
}

TEST(Uncertainty, OfAScaleGrowsWithTheDistance) {
  Matrix7d of_a = Matrix7d::Zero();
  of_a(6, 6) = 0.01 * 0.01;
  const Matrix7d of_b = carriedUncertainty(of_a, {rotationExp({0.1, 0.2, 0.3}), {0, 5, 0}});
  EXPECT_NEAR(std::sqrt((of_b.topLeftCorner<3, 3>().trace())), 0.05, 1e-12);
  EXPECT_NEAR((of_b.block<3, 3>(3, 3).norm()), 0, 1e-15);
}

TEST(Uncertainty, AWhiteningMakesItOne) {
  Eigen::Matrix3d covariance;
  covariance << 4, 1, -0.5, 1, 3, 0.2, -0.5, 0.2, 0.01 + 1;
  const Eigen::Matrix3d whitening = whiteningOf(covariance);
  EXPECT_LT((whitening * covariance * whitening.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace edgeslam
