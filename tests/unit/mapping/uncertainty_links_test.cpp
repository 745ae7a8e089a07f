// Which points count for how well two keyframes are known relative to each other.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mapping/map_uncertainty.h"
#include "unit/map/change_each.h"
#include "unit/mapping/landmark_walk.h"

namespace edgeslam {
namespace {

Map walkedMap(int keyframes, std::uint64_t seed = 5) {
  test::Walk walk(seed, 400);
  for (int i = 0; i < keyframes; ++i) walk.step();
  for (auto& [id, point] : walk.map.points) point.inverse_depth_sigma = 0.02 * point.inverse_depth;
  return walk.map;
}

void forgetObservation(PointId id, Keyframe& keyframe) {
  std::vector<PointObservation> seen(keyframe.observations.begin(), keyframe.observations.end());
  seen.erase(std::remove_if(seen.begin(), seen.end(), [&](const PointObservation& o) { return o.point == id; }),
             seen.end());
  keyframe.observations = seen;
}

void renew(Map& map, const MapUncertaintyOptions& options = {}) {
  renewUncertainty(test::Walk::camera(), options, map);
}

// An adjustment takes outliers out of `seen_in` and leaves the observation.
TEST(UncertaintyLinks, AnOutliersObservationTellsNothing) {
  Map map = walkedMap(8);
  Map without = map;
  int outliers = 0;
  for (auto& [id, point] : map.points) {
    if (id % 3 != 0) continue;
    for (const KeyframeId keyframe : {3, 5}) {
      auto& seen_in = point.seen_in;
      const auto found = std::find(seen_in.begin(), seen_in.end(), keyframe);
      if (found == seen_in.end() || seen_in.size() == 1) continue;
      seen_in.erase(found);
      without.points.at(id).seen_in = seen_in;
      forgetObservation(id, without.keyframes[keyframe]);
      ++outliers;
    }
  }
  ASSERT_GT(outliers, 10);
  renew(map);
  renew(without);
  for (const Keyframe& keyframe : map.keyframes) {
    EXPECT_EQ(keyframe.uncertainty, without.keyframes[keyframe.id].uncertainty) << keyframe.id;
  }
}

// Points that only the third keyframe shares say nothing of the second's place relative to the first.
TEST(UncertaintyLinks, OnlyWhatBothSeeTiesThem) {
  Map map = walkedMap(3);
  for (auto point = map.points.begin(); point != map.points.end();) {
    auto& [id, p] = *point;
    const bool by_two_and_three = id % 2 == 0;
    const KeyframeId host = by_two_and_three ? 2 : 0;
    const bool seen = findObservation(map.keyframes[host], id) && findObservation(map.keyframes[1], id);
    if (!seen) {
      point = map.points.erase(point);
      continue;
    }
    const Eigen::Vector3d in_host = map.keyframes[host].world_T_camera.inverse() * worldPosition(map, p);
    p.host = host;
    p.host_bearing = in_host.normalized();
    p.inverse_depth = 1 / in_host.norm();
    p.inverse_depth_sigma = 0.02 * p.inverse_depth;
    p.seen_in = {1};
    ++point;
  }
  Map of_two = map;
  for (auto point = of_two.points.begin(); point != of_two.points.end();) {
    point = point->second.host == 2 ? of_two.points.erase(point) : std::next(point);
  }
  ASSERT_GT(of_two.points.size(), 15U);
  ASSERT_GT(map.points.size(), of_two.points.size() + 15);
  renew(map);
  renew(of_two);
  EXPECT_GT(map.keyframes[1].uncertainty.trace(), 0);
  EXPECT_EQ(map.keyframes[1].uncertainty, of_two.keyframes[1].uncertainty);
  EXPECT_LT(map.keyframes[2].uncertainty.trace(), 1) << "known by way of the second";
  EXPECT_GT(of_two.keyframes[2].uncertainty.trace(), 1) << "nothing ties it";
}

TEST(UncertaintyLinks, FewerPointsThanAskedForAreNoTie) {
  Map map = walkedMap(2);
  const std::vector<int> shared = sharedPoints(map, 1);
  MapUncertaintyOptions options;
  options.fewest_points = shared[0];
  renew(map, options);
  const double tied = map.keyframes[1].uncertainty.trace();
  options.fewest_points = shared[0] + 1;
  renew(map, options);
  EXPECT_LT(tied, 1);
  EXPECT_GT(map.keyframes[1].uncertainty.trace(), 1);
}

TEST(UncertaintyLinks, ItIsAnHonestCovariance) {
  Map map = walkedMap(12);
  renew(map);
  for (const Keyframe& keyframe : map.keyframes) {
    const Matrix7d& uncertainty = keyframe.uncertainty;
    EXPECT_LT((uncertainty - uncertainty.transpose()).norm(), 1e-9 * (1 + uncertainty.norm()));
    const Eigen::SelfAdjointEigenSolver<Matrix7d> solver(uncertainty);
    EXPECT_GE(solver.eigenvalues()(0), keyframe.id == 0 ? 0 : 1e-12) << keyframe.id;
  }
}

// Points whose depths are less certain leave the scale more open, and measurements that are less certain the pose.
TEST(UncertaintyLinks, GrowWithTheDoubtOfDepthsAndOfMeasurements) {
  MapUncertaintyOptions options;
  options.position_walk = options.rotation_walk = options.scale_walk = 0;
  Map sure = walkedMap(2);
  Map unsure_depth = sure, unsure_pixels = sure;
  for (auto& [id, point] : unsure_depth.points) point.inverse_depth_sigma *= 3;
  for (Keyframe& keyframe : unsure_pixels.keyframes) {
    test::changeEach(keyframe.observations, [&](PointObservation& seen) {
      seen.measurement.sigma_normal *= 3;
      seen.measurement.sigma_tangent *= 3;
    });
  }
  for (Map* map : {&sure, &unsure_depth, &unsure_pixels}) renew(*map, options);
  const Matrix7d &known = sure.keyframes[1].uncertainty, &by_depth = unsure_depth.keyframes[1].uncertainty,
                 &by_pixels = unsure_pixels.keyframes[1].uncertainty;
  EXPECT_NEAR(by_depth(6, 6), 9 * known(6, 6), 1e-6 * by_depth(6, 6));
  EXPECT_NEAR(by_pixels(6, 6), known(6, 6), 1e-6 * known(6, 6));
  for (int i = 0; i < 6; ++i) {
    EXPECT_GT(by_depth(i, i), known(i, i)) << i;
    EXPECT_GT(by_pixels(i, i), known(i, i)) << i;
    EXPECT_LE(by_pixels(i, i), 9.0001 * known(i, i)) << i;
  }
}

// What counts as narrow is twice as wide as the camera's view: the way leads four times as far astray.
TEST(UncertaintyLinks, TheWayLeadsFartherAstrayWhereTheViewIsNarrow) {
  Map map = walkedMap(2);
  const Camera camera = test::Walk::camera();
  MapUncertaintyOptions still, wide, narrow;
  still.position_walk = still.rotation_walk = still.scale_walk = 0;
  wide.narrow_view = 0.5 * camera.width / camera.fx;
  narrow.narrow_view = 2 * wide.narrow_view;
  std::vector<Matrix7d> uncertainties;
  for (const MapUncertaintyOptions& options : {still, wide, narrow}) {
    renew(map, options);
    uncertainties.push_back(map.keyframes[1].uncertainty);
  }
  const Matrix7d added = uncertainties[1] - uncertainties[0], added_by_narrow = uncertainties[2] - uncertainties[0];
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(added_by_narrow(i, i), 16 * added(i, i), 1e-6 * added(i, i)) << i;
  EXPECT_NEAR(added_by_narrow(6, 6), added(6, 6), 1e-9 * added(6, 6));
  wide.narrow_view = 0.1;
  renew(map, wide);
  EXPECT_EQ(map.keyframes[1].uncertainty, uncertainties[1]) << "a wide view is no better than a usual one";
}

// Over the way alone: the variance grows in proportion to its length.
TEST(UncertaintyLinks, TheWayLeadsAstrayAsFarAsTheOptionsSay) {
  Map map = walkedMap(2);
  MapUncertaintyOptions still, astray;
  still.position_walk = still.rotation_walk = still.scale_walk = 0;
  renew(map, still);
  const Matrix7d without = map.keyframes[1].uncertainty;
  renew(map, astray);
  const Matrix7d added = map.keyframes[1].uncertainty - without;
  EXPECT_LT((added - Matrix7d(added.diagonal().asDiagonal())).norm(), 1e-9 * added.norm());
  const Pose moved = map.keyframes[0].world_T_camera.inverse() * map.keyframes[1].world_T_camera;
  const double turn = rotationAngle(map.keyframes[0].world_T_camera.rotation, map.keyframes[1].world_T_camera.rotation);
  const double scale_way = added(6, 6) / (astray.scale_walk * astray.scale_walk);
  EXPECT_GT(scale_way, turn + moved.translation.norm() / 9);
  EXPECT_LT(scale_way, turn + moved.translation.norm() / 2) << "the scene is some 3 to 6 away";
  for (int i = 3; i < 6; ++i) {
    EXPECT_NEAR(added(i, i), astray.rotation_walk * astray.rotation_walk * scale_way, 1e-9);
  }
  for (int i = 0; i < 3; ++i) {
    const double depth = std::sqrt(added(i, i) / scale_way) / astray.position_walk;
    EXPECT_GT(depth, 2.5);
    EXPECT_LT(depth, 7.5);
  }
}

}  // namespace
}  // namespace edgeslam
