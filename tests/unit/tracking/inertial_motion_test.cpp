// What inertia hands to mapping with a keyframe, and that it goes by the offset of the clocks that was found.
#include "tracking/inertial_motion.h"

#include <gtest/gtest.h>

#include "inertia/found_time_offset.h"

namespace edgeslam {
namespace {

constexpr std::int64_t millisecond = 1'000'000;

InertialMotion turning(double rate_until_s, int seconds = 2) {
  InertialMotion motion{InertialUnit()};
  for (int i = 0; i <= 200 * seconds; ++i) {
    InertialSample sample;
    sample.time_ns = 5 * millisecond * i;
    sample.rate.z() = 0.005 * i <= rate_until_s ? 1 : 0;
    motion.add(sample);
  }
  return motion;
}

TEST(InertialMotion, GivesAKeyframeWhatCameSinceTheOneBefore) {
  InertialMotion motion = turning(1);
  motion.observeTurn({0, 30 * millisecond, Eigen::Quaterniond::Identity()});
  motion.observeTurn({30 * millisecond, 60 * millisecond, Eigen::Quaterniond(NAN, 0, 0, 0)});
  TrackedFrame first, second;
  motion.tell(first);
  EXPECT_EQ(first.felt.size(), 401U);
  ASSERT_EQ(first.turns.size(), 1U) << "what is not finite was not seen";
  EXPECT_EQ(first.turns[0].to_ns, 30 * millisecond);
  motion.tell(second);
  EXPECT_TRUE(second.felt.empty() && second.turns.empty());
}

TEST(InertialMotion, KeepsTheLatestWhereAKeyframeIsLongInComing) {
  InertialMotion motion = turning(1, 60);
  TrackedFrame keyframe;
  motion.tell(keyframe);
  EXPECT_LE(keyframe.felt.size(), most_felt);
  EXPECT_GE(keyframe.felt.size(), most_felt / 2);
  EXPECT_EQ(keyframe.felt.back().time_ns, 60000 * millisecond);
}

TEST(InertialMotion, WithoutAUnitHasNothingToGive) {
  InertialMotion motion{std::nullopt};
  motion.add(InertialSample());
  motion.observeTurn({0, 30 * millisecond, Eigen::Quaterniond::Identity()});
  TrackedFrame keyframe;
  motion.tell(keyframe);
  EXPECT_TRUE(keyframe.felt.empty() && keyframe.turns.empty());
}

TEST(InertialMotion, GoesByTheOffsetThatWasFound) {
  InertialMotion motion = turning(1);
  const auto turned = [&] {
    return rotationLog(motion.turnBetween(900 * millisecond, 1100 * millisecond, {})->first_R_second).norm();
  };
  EXPECT_NEAR(turned(), 0.1, 0.006);
  motion.setOffset(50 * millisecond);
  EXPECT_NEAR(turned(), 0.05, 0.006);
  motion.linkFrom(3, 900 * millisecond);
  EXPECT_EQ(motion.linkUpTo(1100 * millisecond, {}).offset_ns, 50 * millisecond);
}

TEST(InertialMotion, ThatIsLeftOutKnowsNothing) {
  InertialMotion motion(InertialUnit{});
  for (int i = 0; i <= 300; ++i) motion.add({i * 5 * millisecond, {1, 0, 0}, Eigen::Vector3d::Zero()});
  motion.linkFrom(3, 500 * millisecond);
  ASSERT_TRUE(motion.isThere());
  ASSERT_TRUE(motion.turnBetween(500 * millisecond, 600 * millisecond, {}));
  ASSERT_EQ(motion.linkUpTo(600 * millisecond, {}).from, 3);
  motion.leaveOut();
  EXPECT_FALSE(motion.isThere());
  EXPECT_FALSE(motion.turnBetween(500 * millisecond, 600 * millisecond, {}));
  EXPECT_LT(motion.linkUpTo(600 * millisecond, {}).from, 0);
}

TEST(InertialMotion, GoesByTheRotationThatWasFound) {
  InertialMotion motion(InertialUnit{});
  for (int i = 0; i <= 300; ++i) motion.add({i * 5 * millisecond, {1, 0, 0}, Eigen::Vector3d::Zero()});
  const auto turned = [&]() {
    return rotationLog(motion.turnBetween(500 * millisecond, 600 * millisecond, {})->first_R_second);
  };
  EXPECT_LT((turned() - Eigen::Vector3d(0.1, 0, 0)).norm(), 1e-9);
  const Eigen::Quaterniond found = rotationExp({0, 0, 0.05});
  motion.setRotation(found);
  EXPECT_LT((turned() - found.conjugate() * Eigen::Vector3d(0.1, 0, 0)).norm(), 1e-9);
}

}  // namespace
}  // namespace edgeslam
