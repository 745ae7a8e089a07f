// P8, P13: the rotation alone between two views, where many matches do not follow it.
#include "geometry/relative_rotation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

struct TurnedMatches {
  Eigen::Quaterniond turn;
  std::vector<Eigen::Vector3d> first, second;
};

// `noise` [rad] in the second bearing; a share of the matches is off by angles of up to `off` [rad] any way.
TurnedMatches turnedMatches(unsigned seed, int count, double noise, double share_off, double off) {
  Random random(seed);
  TurnedMatches matches;
  matches.turn = random.rotation(0.3);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d ray = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 1).normalized();
    const bool is_off = i < share_off * count;
    matches.first.push_back(ray);
    matches.second.push_back(random.rotation(is_off ? random.uniform(0, off) : random.normal(noise)) *
                             (matches.turn * ray));
  }
  return matches;
}

std::vector<double> sortedErrors(const TurnedMatches& matches, const Eigen::Quaterniond& rotation) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < matches.first.size(); ++i) {
    errors.push_back(angleBetween(rotation * matches.first[i], matches.second[i]));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(RelativeRotation, ItsErrorIsTheMedianOfWhatRemains) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TurnedMatches matches = turnedMatches(seed, 41 + static_cast<int>(seed), 0.01, 0.3, 0.4);
    const RelativeRotation found = relativeRotation(matches.first, matches.second);
    const std::vector<double> errors = sortedErrors(matches, found.rotation);
    EXPECT_NEAR(found.median_error, errors[errors.size() / 2], 1e-12) << "seed " << seed;
    EXPECT_LT(errors[errors.size() / 4], 0.7 * found.median_error) << "another quantile would be told from it";
  }
}

// It is the least-squares rotation of those within two and a half medians: turning it further makes these worse.
TEST(RelativeRotation, NoRotationNearByFitsTheMatchesThatItKeptBetter) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TurnedMatches matches = turnedMatches(seed, 200, 0.003, 0.3, 1.0);
    const RelativeRotation found = relativeRotation(matches.first, matches.second);
    const auto squares = [&](const Eigen::Quaterniond& rotation) {
      double sum = 0;
      for (std::size_t i = 0; i < matches.first.size(); ++i) {
        const double error = angleBetween(found.rotation * matches.first[i], matches.second[i]);
        if (error > 2.5 * found.median_error) continue;
        sum += (rotation * matches.first[i] - matches.second[i]).squaredNorm();
      }
      return sum;
    };
    const double least = squares(found.rotation);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-1e-4, 1e-4}) {
        EXPECT_GT(squares(rotationExp(step * Eigen::Vector3d::Unit(axis)) * found.rotation), least) << "seed " << seed;
      }
    }
  }
}

// Matches off to one side pull the mean, not what is left after trimming.
TEST(RelativeRotation, MatchesThatAreOffToOneSideDoNotPullIt) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    TurnedMatches matches = turnedMatches(seed, 200, 0.001, 0, 0);
    for (std::size_t i = 0; i < 50; ++i) matches.second[i] = rotationExp({0, 0.2, 0}) * matches.second[i];
    const RelativeRotation found = relativeRotation(matches.first, matches.second);
    EXPECT_LT(rotationAngle(found.rotation, matches.turn), 0.001) << "seed " << seed;
    EXPECT_LT(found.median_error, 0.003);
  }
}

// Bearings in one plane allow a mirror image, too.
TEST(RelativeRotation, NeverAMirrorImage) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Eigen::Quaterniond turn = random.rotation(1), plane = random.rotation(2);
    std::vector<Eigen::Vector3d> first, second;
    for (int i = 0; i < 30; ++i) {
      const double angle = random.uniform(0, 1);
      first.push_back(plane * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
      second.push_back(turn * first.back());
    }
    const RelativeRotation found = relativeRotation(first, second);
    EXPECT_LT(rotationAngle(found.rotation, turn), 1e-6) << "seed " << seed;
    EXPECT_LT(found.median_error, 1e-6);
  }
}

}  // namespace
}  // namespace edgeslam
