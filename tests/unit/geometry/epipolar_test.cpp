// P8, P14, P21: the relative pose of two views, in noise, among outliers and where a rotation explains all.
#include "geometry/epipolar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/relative_rotation.h"
#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

struct Matches {
  std::vector<Eigen::Vector3d> first, second;
  std::vector<char> good;
  Pose second_T_first;
};

// `count` matches between two views, with noise [px] in both and a share of matches whose second pixel is anywhere.
Matches makeMatches(unsigned seed, int count, const Pose& second_T_first, Structure structure, double noise,
                    double outliers, const Camera& camera = pinholeCamera()) {
  Random random(seed);
  Matches matches;
  matches.second_T_first = second_T_first;
  while (static_cast<int>(matches.first.size()) < count) {
    const Eigen::Vector2d pixel = randomPixel(camera, random);
    const Eigen::Vector3d ray = bearing(camera, pixel);
    const Eigen::Vector3d plane(0.2, 0.1, 1);
    const double depth = structure == Structure::plane ? 3.0 / plane.dot(ray) : random.uniform(2, 6);
    const Eigen::Vector3d in_second = second_T_first * (depth * ray);
    if (in_second.z() < 0.1) continue;
    Eigen::Vector2d second_pixel = project(camera, in_second);
    if (!insideImage(camera, second_pixel)) continue;
    const bool good = static_cast<double>(matches.first.size()) >= outliers * count;
    if (!good) second_pixel = randomPixel(camera, random);
    const auto noisy = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(p.x() + random.normal(noise), p.y() + random.normal(noise));
    };
    matches.first.push_back(bearing(camera, noisy(pixel)));
    matches.second.push_back(bearing(camera, noisy(second_pixel)));
    matches.good.push_back(good);
  }
  return matches;
}

Pose sidewaysMotion() { return {rotationExp({0.05, -0.1, 0.08}), {-0.5, 0.15, 0.1}}; }

double rotationError(const RelativePose& found, const Matches& matches) {
  return rotationAngle(found.second_T_first.rotation, matches.second_T_first.rotation);
}

double directionError(const RelativePose& found, const Matches& matches) {
  return angleBetween(found.second_T_first.translation, matches.second_T_first.translation);
}

TEST(RelativePose, RecoversNoiselessPoseExactly) {
  const Matches matches = makeMatches(1, 60, sidewaysMotion(), Structure::volume, 0, 0);
  const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, 7);
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.inlier_count, 60);
  EXPECT_LT(rotationError(found, matches), 1e-7);
  EXPECT_LT(directionError(found, matches), 1e-7);
  EXPECT_NEAR(found.second_T_first.translation.norm(), 1, 1e-12);
}

// 280 good matches at this motion determine the rotation to 0.05 degrees (Cramer-Rao bound, all three angles together).
TEST(RelativePose, RecoversPoseUnderNoiseAndOutliers) {
  double sum_squared = 0;
  const unsigned trials = 20;
  for (unsigned seed = 0; seed < trials; ++seed) {
    const Matches matches = makeMatches(seed, 400, sidewaysMotion(), Structure::volume, 0.3, 0.3);
    const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, seed);
    ASSERT_TRUE(found.found);
    sum_squared += std::pow(rotationError(found, matches), 2);
    EXPECT_LT(rotationError(found, matches), 0.15 * degree) << "seed " << seed;
    EXPECT_LT(directionError(found, matches), degree) << "seed " << seed;
    int good = 0, wrong = 0;
    for (std::size_t i = 0; i < matches.good.size(); ++i) {
      if (found.inliers[i]) ++(matches.good[i] ? good : wrong);
    }
    EXPECT_EQ(good + wrong, found.inlier_count);
    EXPECT_GE(good, 275) << "of 280";
    EXPECT_LE(wrong, 8) << "of 120; a wrong match may lie on its epipolar line";
    EXPECT_LT(found.rotation_only_share, 0.3);
    EXPECT_GT(found.parallax, 3 * degree);
  }
  EXPECT_LT(std::sqrt(sum_squared / trials), 0.06 * degree);
}

TEST(RelativePose, RecoversForwardMotionAndFisheye) {
  const Pose forward{rotationExp({0.02, 0.03, -0.05}), {0.02, -0.03, -0.6}};
  const Matches matches = makeMatches(3, 400, forward, Structure::volume, 0.3, 0.2);
  const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, 1);
  ASSERT_TRUE(found.found);
  EXPECT_LT(rotationError(found, matches), 0.1 * degree);
  EXPECT_LT(directionError(found, matches), degree);

  const Matches wide = makeMatches(4, 400, sidewaysMotion(), Structure::volume, 0.2, 0.2, fisheyeCamera());
  const RelativePose found_wide = relativePose(wide.first, wide.second, 1.0 / 190, 1);
  ASSERT_TRUE(found_wide.found);
  EXPECT_LT(rotationError(found_wide, wide), 0.1 * degree);
  EXPECT_LT(directionError(found_wide, wide), degree);
  EXPECT_GE(found_wide.inlier_count, 310) << "of 320: those outside the normalized plane count as well";
}

// A plane leaves one solution where some of its points are nearer to one camera and some to the other (Longuet-Higgins
// 1986), as in sideways motion. Otherwise it may leave two that explain every match alike.
TEST(RelativePose, RecoversPlanarScene) {
  const Pose approaching{rotationExp({0.05, -0.1, 0.08}), {-0.3, 0.1, -0.6}};
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Matches matches = makeMatches(seed, 300, sidewaysMotion(), Structure::plane, 0.1, 0.1);
    const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, seed);
    ASSERT_TRUE(found.found);
    EXPECT_LT(rotationError(found, matches), 0.3 * degree) << "seed " << seed;
    EXPECT_LT(directionError(found, matches), 2 * degree) << "seed " << seed;
    const Matches ambiguous = makeMatches(seed, 300, approaching, Structure::plane, 0.1, 0.1);
    EXPECT_GE(relativePose(ambiguous.first, ambiguous.second, one_pixel_rad, seed).inlier_count, 268) << "of 270";
  }
}

TEST(RelativePose, TellsRotationOnlyByItsShareAndParallax) {
  const Pose turn{rotationExp({0.1, -0.15, 0.2}), Eigen::Vector3d::Zero()};
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Matches matches = makeMatches(seed, 300, turn, Structure::volume, 0.3, 0);
    const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, seed);
    EXPECT_FALSE(found.found);
    EXPECT_GT(found.rotation_only_share, 0.98);
    EXPECT_LT(found.parallax, 0.1 * degree);
    EXPECT_LT(rotationError(found, matches), 0.05 * degree);
    const Matches with_outliers = makeMatches(seed, 300, turn, Structure::volume, 0.3, 0.3);
    const RelativePose doubtful = relativePose(with_outliers.first, with_outliers.second, one_pixel_rad, seed);
    EXPECT_GT(doubtful.rotation_only_share, 0.68) << "of 0.7";
    EXPECT_LT(doubtful.parallax, 0.2 * degree);
  }
}

TEST(RelativePose, AnswersDegenerateInputWithoutThrowing) {
  const Matches matches = makeMatches(5, 20, sidewaysMotion(), Structure::volume, 0.1, 0);
  for (const std::size_t count : {0, 1, 4, 5, 7}) {
    const std::vector<Eigen::Vector3d> first(matches.first.begin(), matches.first.begin() + static_cast<long>(count));
    const std::vector<Eigen::Vector3d> second(matches.second.begin(),
                                              matches.second.begin() + static_cast<long>(count));
    const RelativePose found = relativePose(first, second, one_pixel_rad, 1);
    EXPECT_FALSE(found.found) << count;
    EXPECT_EQ(found.inliers.size(), count);
  }
  const std::vector<Eigen::Vector3d> same(20, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(relativePose(same, same, one_pixel_rad, 1).found);
  EXPECT_NO_THROW(relativePose(same, matches.second, one_pixel_rad, 1));
  EXPECT_NO_THROW(relativePose(matches.first, same, one_pixel_rad, 1));
  const std::vector<Eigen::Vector3d> behind(20, -Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(relativePose(behind, matches.second, one_pixel_rad, 1).found);
}

TEST(RelativePose, IsAFunctionOfItsSeed) {
  const Matches matches = makeMatches(6, 200, sidewaysMotion(), Structure::volume, 0.5, 0.5);
  const RelativePose a = relativePose(matches.first, matches.second, one_pixel_rad, 3);
  const RelativePose b = relativePose(matches.first, matches.second, one_pixel_rad, 3);
  EXPECT_EQ(a.second_T_first.rotation.coeffs(), b.second_T_first.rotation.coeffs());
  EXPECT_EQ(a.second_T_first.translation, b.second_T_first.translation);
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST(RelativeRotation, RecoversRotationUnderOutliers) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Pose turn{random.rotation(0.25), Eigen::Vector3d::Zero()};
    const Matches matches = makeMatches(seed, 200, turn, Structure::volume, 0.3, 0.3);
    const RelativeRotation found = relativeRotation(matches.first, matches.second);
    EXPECT_LT(rotationAngle(found.rotation, turn.rotation), 0.05 * degree) << "seed " << seed;
    EXPECT_LT(found.median_error, 0.2 * degree);
  }
}

TEST(RelativeRotation, ProperRotationFromFewMatches) {
  EXPECT_EQ(relativeRotation({}, {}).median_error, 0);
  Random random(1);
  const Eigen::Quaterniond turn = random.rotation(1);
  for (int count = 1; count < 4; ++count) {
    std::vector<Eigen::Vector3d> first, second;
    for (int i = 0; i < count; ++i) {
      first.push_back(random.direction());
      second.push_back(turn * first.back());
    }
    const RelativeRotation found = relativeRotation(first, second);
    EXPECT_NEAR(found.rotation.norm(), 1, 1e-12);
    EXPECT_LT(found.median_error, 1e-7);
    if (count > 1) {
      EXPECT_LT(rotationAngle(found.rotation, turn), 1e-7);
    }
  }
}

}  // namespace
}  // namespace edgeslam
