// What gravity and metres say of a loop.
#include "places/known_frame.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

Similarity someSimilarity(std::uint64_t seed) {
  test::Random random(seed);
  const Pose pose = test::randomPose(random, 2, 1.5);
  return {test::uniform(random, 0.5, 2), pose.rotation, pose.translation};
}

// Two frames that `to_S_from` is true of.
KnownFrame frameFrom() { return {2.0, Eigen::Vector3d(0.6, 0, 0.8)}; }
KnownFrame frameTo(const Similarity& to_S_from) {
  const KnownFrame from = frameFrom();
  return {*from.metres_a_unit / to_S_from.scale, Eigen::Vector3d(to_S_from.rotation * *from.up)};
}

double tiltBetween(const KnownFrame& from, const KnownFrame& to, const Similarity& to_S_from) {
  return (to_S_from.rotation * *from.up - *to.up).norm();
}

TEST(KnownFrame, ComesFromInertiaBeforeWheels) {
  Map map;
  EXPECT_FALSE(knownFrame(map, 0).metres_a_unit || knownFrame(map, 0).up);
  map.wheels[0] = {true, 3.0, 0.01};
  EXPECT_EQ(knownFrame(map, 0).metres_a_unit, 3.0);
  EXPECT_FALSE(knownFrame(map, 0).up);
  InertialAlignment& alignment = map.inertia[0];
  alignment.gravity = {0, 9.8, 0};
  alignment.metres_a_unit = 2.5;
  EXPECT_EQ(knownFrame(map, 0).metres_a_unit, 3.0);  // it is not known yet
  alignment.is_known = true;
  EXPECT_EQ(knownFrame(map, 0).metres_a_unit, 2.5);
  EXPECT_EQ(*knownFrame(map, 0).up, Eigen::Vector3d(0, -1, 0));
  EXPECT_FALSE(knownFrame(map, 1).metres_a_unit);
}

TEST(KnownFrame, WhatIsTrueIsNoContradictionAndStays) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Similarity truth = someSimilarity(seed);
    const KnownFrame from = frameFrom(), to = frameTo(truth);
    EXPECT_EQ(contradiction(from, to, truth, {}), "");
    const Similarity right = putRight(from, to, truth, {1, 2, 3});
    EXPECT_NEAR(right.scale, truth.scale, 1e-12);
    EXPECT_LT(rotationAngle(right.rotation, truth.rotation), 1e-7);
    EXPECT_LT((right.translation - truth.translation).norm(), 1e-6);
  }
}

TEST(KnownFrame, WhatIsKnownIsPutRightAboutThePlaceThatWasMet) {
  const Eigen::Vector3d place(1, -2, 3);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Similarity truth = someSimilarity(seed);
    const KnownFrame from = frameFrom(), to = frameTo(truth);
    const Similarity found = truth * Similarity{1.1, rotationExp({0.02, 0.03, -0.01}), {0.1, 0, 0}};
    const Similarity right = putRight(from, to, found, place);
    EXPECT_LT(tiltBetween(from, to, right), 1e-9);
    EXPECT_NEAR(right.scale, truth.scale, 1e-12);
    EXPECT_LT((right * place - found * place).norm(), 1e-9);
    EXPECT_LE(rotationAngle(right.rotation, truth.rotation), rotationAngle(found.rotation, truth.rotation) + 1e-9);
  }
}

TEST(KnownFrame, NothingChangesWhereOneOfThemIsUnknown) {
  const Similarity found = someSimilarity(3);
  const KnownFrame known = frameFrom(), unknown;
  for (const auto& [from, to] : {std::pair(known, unknown), std::pair(unknown, known), std::pair(unknown, unknown)}) {
    EXPECT_EQ(contradiction(from, to, found, {}), "");
    const Similarity right = putRight(from, to, found, {1, 2, 3});
    EXPECT_EQ(right.scale, found.scale);
    EXPECT_EQ(right.rotation.coeffs(), found.rotation.coeffs());
    EXPECT_LT((right.translation - found.translation).norm(), 1e-12);
  }
}

TEST(KnownFrame, TiltsAndOtherLengthsAreTold) {
  const Similarity truth = someSimilarity(5);
  const KnownFrame from = frameFrom(), to = frameTo(truth);
  const Eigen::Vector3d level = from.up->unitOrthogonal();
  const auto turned = [&](const Eigen::Vector3d& axis, double degrees) {
    return truth * Similarity{1, rotationExp(radians(degrees) * axis), Eigen::Vector3d::Zero()};
  };
  EXPECT_EQ(contradiction(from, to, turned(*from.up, 60), {}), "");
  EXPECT_EQ(contradiction(from, to, turned(level, 4), {}), "");
  EXPECT_EQ(contradiction(from, to, turned(level, 12), {}), "would tilt what is upright by 12 deg");
  EXPECT_EQ(contradiction(from, to, turned(level, 180), {}), "would tilt what is upright by 180 deg");
  Similarity longer = truth, shorter = truth;
  longer.scale *= 1.7;
  shorter.scale *= 0.5;
  EXPECT_EQ(contradiction(from, to, longer, {}), "would make what is known in metres 1.70 times as long");
  EXPECT_EQ(contradiction(from, to, shorter, {}), "would make what is known in metres 0.50 times as long");
}

}  // namespace
}  // namespace edgeslam
