#include "mapping/rays_anew.h"

#include <gtest/gtest.h>

#include "unit/mapping/rolling_walk.h"

namespace edgeslam {
namespace {

Camera otherCamera() {
  Camera other = test::Walk::camera();
  other.readout_s = 0.03;
  other.fx *= 1.1;
  other.fy *= 1.1;
  return other;
}

// Of a map whose rays are those of `camera`.
void expectRaysOf(const Camera& camera, const Map& map) {
  ASSERT_GT(map.points.size(), 50U);
  for (const auto& [id, point] : map.points) {
    const Keyframe& host = map.keyframes[point.host];
    const Eigen::Vector2d seen = findObservation(host, id)->measurement.pixel;
    const Pose row_T_camera = rowPose(camera, host.twist, seen.y()).inverse();
    const Eigen::Vector2d shown = project(camera, row_T_camera * (point.host_bearing / point.inverse_depth));
    EXPECT_LT((shown - seen).norm(), 0.01) << id;
  }
}

TEST(RaysAnew, PointsAreSeenWhereTheirHostsMeasuredThem) {
  test::Walk walk = test::rollingWalk(1, 16, 0.02, 0.5, 0.3);
  expectRaysOf(test::Walk::camera(), walk.map);
  takeRaysAnew(otherCamera(), test::allKeyframes(walk.map), walk.map);
  expectRaysOf(otherCamera(), walk.map);
}

TEST(RaysAnew, OtherKeyframesAndTheirPointsStay) {
  test::Walk walk = test::rollingWalk(2, 16, 0.02, 0.5, 0.3);
  const Map before = walk.map;
  takeRaysAnew(otherCamera(), {3}, walk.map);
  int changed = 0;
  for (const auto& [id, point] : walk.map.points) {
    const bool stays = point.host_bearing == before.points.at(id).host_bearing;
    EXPECT_EQ(stays, point.host != 3) << id;
    changed += stays ? 0 : 1;
  }
  EXPECT_GT(changed, 0);
}

}  // namespace
}  // namespace edgeslam
