// Which poses make a turn.
#include "inertia/camera_turns.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

PosedCamera posed(std::int64_t time_ms, int world, double angle_rad) {
  return {time_ms * 1'000'000, world, {rotationExp({0, angle_rad, 0}), Eigen::Vector3d::Zero()}};
}

TEST(CameraTurns, GoToTheFirstPoseThatIsLateEnough) {
  const std::vector<CameraTurn> turns =
      cameraTurns({posed(0, 0, 0.0), posed(90, 0, 0.1), posed(210, 0, 0.3), posed(295, 0, 0.6)}, 0.2);
  ASSERT_EQ(turns.size(), 2U);
  EXPECT_EQ(turns[0].to_ns, 210'000'000);
  EXPECT_NEAR(rotationLog(turns[0].rotation).y(), 0.3, 1e-12);
  EXPECT_EQ(turns[1].from_ns, 90'000'000);
  EXPECT_NEAR(rotationLog(turns[1].rotation).y(), 0.5, 1e-12);
  EXPECT_NEAR(secondsOf(turns[1]), 0.205, 1e-12);
}

TEST(CameraTurns, StayWithinAWorldAndOffLongGaps) {
  EXPECT_TRUE(cameraTurns({posed(0, 0, 0), posed(200, 1, 1)}, 0.2).empty()) << "another world";
  EXPECT_TRUE(cameraTurns({posed(0, 0, 0), posed(310, 0, 1)}, 0.2).empty()) << "no frame in time";
  EXPECT_EQ(cameraTurns({posed(0, 0, 0), posed(290, 0, 1)}, 0.2).size(), 1U);
  EXPECT_TRUE(cameraTurns({}, 0.2).empty());
}

}  // namespace
}  // namespace edgeslam
