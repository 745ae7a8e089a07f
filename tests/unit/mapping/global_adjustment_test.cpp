// P20: bundle adjustment of all keyframes and points.
#include "mapping/global_adjustment.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"
#include "unit/map/change_each.h"

namespace edgeslam {
namespace {

// Keyframes on an arc that returns to its start, points seen by all keyframes before which they lie.
Map makeMap(const Camera& camera, int keyframes, int points, std::uint64_t seed) {
  test::Random random(seed);
  Map map;
  for (int k = 0; k < keyframes; ++k) {
    const double angle = 2 * M_PI * k / (keyframes - 1);
    Keyframe keyframe;
    keyframe.id = k;
    keyframe.world_T_camera.translation = {std::sin(angle), 0.3 * std::sin(2 * angle), 1 - std::cos(angle)};
    keyframe.world_T_camera.rotation = rotationExp({0.05 * std::sin(angle), 0.1 * std::sin(angle), 0});
    map.keyframes.push_back(keyframe);
  }
  for (PointId id = 0; id < points; ++id) {
    MapPoint point;
    point.id = id;
    point.host = static_cast<KeyframeId>(id % keyframes);
    point.host_bearing = bearing(camera, test::randomPixel(random, camera));
    point.inverse_depth = 1 / test::uniform(random, 4, 8);
    point.inverse_depth_sigma = 0.01;
    const Eigen::Vector3d position = worldPosition(map, point);
    for (Keyframe& keyframe : map.keyframes) {
      const Eigen::Vector3d seen = keyframe.world_T_camera.inverse() * position;
      if (!inFront(camera, seen) || !insideImage(camera, project(camera, seen), 5)) continue;
      PointObservation observation;
      observation.point = id;
      const bool corner = id % 3 == 0;
      observation.measurement = test::measure(random, project(camera, seen), test::uniform(random, 0, 6),
                                              corner ? 0.2 : 0.5, corner ? 0.4 : 1000, 0);
      observation.measurement.pixel = project(camera, seen);
      keyframe.observations.push_back(observation);
      if (keyframe.id != point.host) point.seen_in.push_back(keyframe.id);
    }
    if (point.seen_in.size() > 1) map.points.emplace(id, point);
  }
  return map;
}

double largestError(const Map& map, const Map& truth) {
  double largest = 0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Pose& is = map.keyframes[k].world_T_camera;
    const Pose& should_be = truth.keyframes[k].world_T_camera;
    largest = std::max(largest, (is.translation - should_be.translation).norm());
  }
  return largest;
}

// Of the keyframes' distances from the first, which is the origin.
double sizeOf(const Map& map) {
  double sum = 0;
  for (const Keyframe& keyframe : map.keyframes) sum += keyframe.world_T_camera.translation.norm();
  return sum;
}

TEST(GlobalAdjustment, BringsAWholeMapBackThatEndsWhereItBegan) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  const Map truth = makeMap(camera, 12, 300, 1);
  Map map = truth;
  test::Random random(2);
  for (std::size_t k = 1; k < map.keyframes.size(); ++k) {
    map.keyframes[k].world_T_camera = test::perturbed(random, map.keyframes[k].world_T_camera, 0.02, 0.01);
  }
  for (auto& [id, point] : map.points) point.inverse_depth *= 1 + test::uniform(random, -0.03, 0.03);
  ASSERT_GT(largestError(map, truth), 0.01);
  GlobalAdjustmentOptions options;
  options.bundle.iterations = 30;
  ASSERT_TRUE(adjustGlobally(camera, options, {}, map));
  EXPECT_EQ(map.keyframes[0].world_T_camera.translation, truth.keyframes[0].world_T_camera.translation);
  EXPECT_EQ(map.keyframes[0].world_T_camera.rotation.coeffs(), truth.keyframes[0].world_T_camera.rotation.coeffs());
  // But for the size: that of the perturbed map is kept, which is not quite the true one's.
  const double scale = sizeOf(truth) / sizeOf(map);
  EXPECT_NEAR(scale, 1, 0.03);
  for (Keyframe& keyframe : map.keyframes) keyframe.world_T_camera.translation *= scale;
  EXPECT_LT(largestError(map, truth), 1e-9);
  for (const auto& [id, point] : map.points) {
    EXPECT_NEAR(point.inverse_depth / scale, truth.points.at(id).inverse_depth, 1e-9);
  }
}

TEST(GlobalAdjustment, AMapAtItsBestStaysThere) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  const Map truth = makeMap(camera, 8, 150, 3);
  Map map = truth;
  ASSERT_TRUE(adjustGlobally(camera, {}, {}, map));
  EXPECT_LT(largestError(map, truth), 1e-6);
  EXPECT_EQ(map.points.size(), truth.points.size());
}

TEST(GlobalAdjustment, OutliersAreTakenOut) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  Map map = makeMap(camera, 8, 150, 4);
  const PointId wrong = map.points.begin()->first;
  const KeyframeId keyframe = map.points.at(wrong).seen_in.back();
  test::changeEach(map.keyframes[keyframe].observations, [&](PointObservation& observation) {
    if (observation.point == wrong) observation.measurement.pixel += 40 * observation.measurement.normal;
  });
  ASSERT_TRUE(adjustGlobally(camera, {}, {}, map));
  const auto point = map.points.find(wrong);
  if (point != map.points.end()) {
    for (const KeyframeId k : point->second.seen_in) EXPECT_NE(k, keyframe);
  }
}

TEST(GlobalAdjustment, TooLittleOfAMapIsLeftAlone) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  Map map;
  EXPECT_FALSE(adjustGlobally(camera, {}, {}, map));
  map.keyframes.push_back(Keyframe());
  EXPECT_FALSE(adjustGlobally(camera, {}, {}, map));
}

}  // namespace
}  // namespace edgeslam
