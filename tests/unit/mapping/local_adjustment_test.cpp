// P18, P19: bundle adjustment around the new keyframe, and what it takes out.
#include "mapping/local_adjustment.h"

#include <gtest/gtest.h>

#include "unit/map/change_each.h"
#include "unit/mapping/edge_scene.h"

namespace edgeslam {
namespace {

// A camera that goes along the wall, `count` keyframes.
std::vector<Pose> alongTheWall(int count, double step = 0.12) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back({rotationExp({0.01 * i, -0.02 * i, 0.015 * i}), {step * i, 0.03 * i * (i % 2), 0.02 * i}});
  }
  return poses;
}

struct SyntheticMap {
  test::EdgeScene scene = test::framesOnAWall(8);
  std::vector<Pose> truth;
  Map map;

  explicit SyntheticMap(int keyframes, const test::Sight& sight = test::Sight(), std::uint64_t seed = 9)
      : truth(alongTheWall(keyframes)) {
    test::Random random(seed);
    map = test::keyframesOf(test::distorted_camera, scene, truth, sight, random);
    test::addAllPoints(scene, map);
  }

  // Moves keyframes from `first` on and all depths off their places.
  void disturb(KeyframeId first, double translation = 0.02, double rotation = 0.01, double depth = 0.05) {
    test::Random random(10);
    for (Keyframe& keyframe : map.keyframes) {
      if (keyframe.id >= first) {
        keyframe.world_T_camera = test::perturbed(random, keyframe.world_T_camera, translation, rotation);
      }
    }
    for (auto& [id, point] : map.points) point.inverse_depth *= 1 + test::uniform(random, -depth, depth);
  }

  double largestPoseError() const {
    double largest = 0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const Pose& pose = map.keyframes[k].world_T_camera;
      largest = std::max(
          {largest, (pose.translation - truth[k].translation).norm(), rotationAngle(pose.rotation, truth[k].rotation)});
    }
    return largest;
  }

  double medianPointError() const {
    std::vector<double> errors;
    for (const auto& [id, point] : map.points) {
      errors.push_back((worldPosition(map, point) - scene.points[static_cast<std::size_t>(id)].position).norm());
    }
    std::sort(errors.begin(), errors.end());
    return errors.empty() ? HUGE_VAL : errors[errors.size() / 2];
  }
};

TEST(LocalAdjustment, RecoversAnExactMap) {
  SyntheticMap synthetic(5);
  ASSERT_GT(synthetic.map.points.size(), 200U);
  synthetic.disturb(3);
  LocalAdjustmentOptions options;
  options.bundle.iterations = 50;
  // Keyframes 1 and 2 are fixed and hold pose and scale.
  ASSERT_TRUE(adjustKeyframes(test::distorted_camera, options, {3, 4}, {1, 2}, synthetic.map));
  EXPECT_LT(synthetic.largestPoseError(), 1e-3);
  EXPECT_LT(synthetic.medianPointError(), 1e-2);
}

TEST(LocalAdjustment, KeyframeZeroDoesNotMoveByABit) {
  SyntheticMap synthetic(4, {1.0, 1.0});
  synthetic.disturb(1);
  const Pose first = synthetic.map.keyframes[0].world_T_camera;
  const Pose second = synthetic.map.keyframes[1].world_T_camera;
  ASSERT_TRUE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), synthetic.map));
  EXPECT_TRUE(test::sameBytes(synthetic.map.keyframes[0].world_T_camera, first));
  EXPECT_FALSE(test::sameBytes(synthetic.map.keyframes[1].world_T_camera, second));
}

TEST(LocalAdjustment, FixedKeyframesDoNotMoveByABit) {
  SyntheticMap synthetic(6, {1.0, 1.0});
  synthetic.disturb(1);
  const Map before = synthetic.map;
  ASSERT_TRUE(adjustKeyframes(test::distorted_camera, LocalAdjustmentOptions(), {4, 5}, {2, 3}, synthetic.map));
  for (const std::size_t k : {0, 1, 2, 3}) {
    EXPECT_TRUE(test::sameBytes(synthetic.map.keyframes[k].world_T_camera, before.keyframes[k].world_T_camera)) << k;
  }
  for (const std::size_t k : {4, 5}) {
    EXPECT_FALSE(test::sameBytes(synthetic.map.keyframes[k].world_T_camera, before.keyframes[k].world_T_camera)) << k;
  }
}

// With only keyframe 0 to hold it, the whole map might grow or shrink.
TEST(LocalAdjustment, KeepsTheScaleOfAYoungMap) {
  SyntheticMap synthetic(4, {1.0, 1.0});
  synthetic.disturb(1, 0.01, 0.005, 0.03);
  const double newest = synthetic.map.keyframes[3].world_T_camera.translation.norm();
  for (int repetition = 0; repetition < 5; ++repetition) {
    ASSERT_TRUE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), synthetic.map));
    EXPECT_NEAR(synthetic.map.keyframes[3].world_T_camera.translation.norm(), newest, 1e-6);
  }
  // And it is the right map at that scale.
  const double scale = newest / synthetic.truth[3].translation.norm();
  std::vector<double> errors;
  for (const auto& [id, point] : synthetic.map.points) {
    errors.push_back(
        (worldPosition(synthetic.map, point) / scale - synthetic.scene.points[static_cast<std::size_t>(id)].position)
            .norm());
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.1);
}

TEST(LocalAdjustment, TakesOutliersOutAndKeepsTheRest) {
  SyntheticMap synthetic(6, {0.7, 1.0});
  std::vector<std::pair<PointId, KeyframeId>> wrong;
  for (auto& [id, point] : synthetic.map.points) {
    if (id % 12 != 0 || point.seen_in.size() < 3) continue;
    Keyframe& keyframe = synthetic.map.keyframes[static_cast<std::size_t>(point.seen_in.back())];
    test::changeEach(keyframe.observations, [seen = id](PointObservation& observation) {
      Measurement& m = observation.measurement;
      if (observation.point == seen) m.pixel += 15 * m.normal;
    });
    wrong.emplace_back(id, keyframe.id);
  }
  ASSERT_GT(wrong.size(), 10U);
  std::size_t views = 0, views_left = 0;
  for (const auto& [id, point] : synthetic.map.points) views += point.seen_in.size();
  ASSERT_TRUE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), synthetic.map));
  for (const auto& [id, keyframe] : wrong) {
    const auto point = synthetic.map.points.find(id);
    if (point == synthetic.map.points.end()) continue;
    const auto& seen_in = point->second.seen_in;
    EXPECT_EQ(std::count(seen_in.begin(), seen_in.end(), keyframe), 0) << id;
  }
  for (const auto& [id, point] : synthetic.map.points) views_left += point.seen_in.size();
  EXPECT_GT(static_cast<double>(views_left), 0.95 * static_cast<double>(views - wrong.size()));
  EXPECT_LT(synthetic.largestPoseError(), 0.03);
}

TEST(LocalAdjustment, TakesOutAPointThatLostItsDepth) {
  SyntheticMap synthetic(4);
  LocalAdjustmentOptions options;
  options.largest_depth_sigma = 1e-6;
  ASSERT_TRUE(adjustLocally(test::distorted_camera, options, synthetic.map));
  EXPECT_TRUE(synthetic.map.points.empty());
}

TEST(LocalAdjustment, LeavesADistantPartOfTheMapAlone) {
  // Keyframes 0 and 1 see another wall than 2 to 4 do.
  SyntheticMap synthetic(5, {0.5, 0.5});
  const PointId half = static_cast<PointId>(synthetic.scene.points.size() / 2);
  for (Keyframe& keyframe : synthetic.map.keyframes) {
    std::vector<PointObservation> seen(keyframe.observations.begin(), keyframe.observations.end());
    seen.erase(std::remove_if(seen.begin(), seen.end(),
                              [&](const PointObservation& o) { return (o.point < half) != (keyframe.id < 2); }),
               seen.end());
    keyframe.observations = seen;
  }
  synthetic.map.points.clear();
  test::addAllPoints(synthetic.scene, synthetic.map);
  const Map before = synthetic.map;
  ASSERT_TRUE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), synthetic.map));
  for (const auto& [id, point] : before.points) {
    if (id >= half) continue;
    ASSERT_EQ(synthetic.map.points.count(id), 1U);
    EXPECT_EQ(synthetic.map.points.at(id).inverse_depth, point.inverse_depth);
  }
  EXPECT_TRUE(test::sameBytes(synthetic.map.keyframes[1].world_T_camera, before.keyframes[1].world_T_camera));
}

TEST(LocalAdjustment, OnlyTheKeyframesWithMostInCommonMove) {
  SyntheticMap synthetic(7, {0.7, 0.5});
  const Map before = synthetic.map;
  LocalAdjustmentOptions options;
  options.free_keyframes = 3;
  ASSERT_TRUE(adjustLocally(test::distorted_camera, options, synthetic.map));
  int moved = 0;
  for (std::size_t k = 0; k < before.keyframes.size(); ++k) {
    moved += !test::sameBytes(synthetic.map.keyframes[k].world_T_camera, before.keyframes[k].world_T_camera);
  }
  EXPECT_LE(moved, 3);
  EXPECT_FALSE(test::sameBytes(synthetic.map.keyframes.back().world_T_camera, before.keyframes.back().world_T_camera));
}

TEST(LocalAdjustment, NoiseAveragesOut) {
  // Twenty keyframes of noise in the measurements; the poses come out better than any one of them allows.
  SyntheticMap synthetic(6, {1.0, 1.5});
  synthetic.disturb(2, 0.01, 0.005, 0.05);
  LocalAdjustmentOptions options;
  options.bundle.iterations = 20;
  ASSERT_TRUE(adjustKeyframes(test::distorted_camera, options, {2, 3, 4, 5}, {0, 1}, synthetic.map));
  EXPECT_LT(synthetic.largestPoseError(), 0.02);
  EXPECT_LT(synthetic.medianPointError(), 0.06);
}

TEST(LocalAdjustment, TheSameMapComesOutTheSameToTheLastBit) {
  const test::Sight noisy{1.0, 1.0};
  SyntheticMap a(6, noisy), b(6, noisy);
  a.disturb(1);
  b.disturb(1);
  ASSERT_TRUE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), a.map));
  ASSERT_TRUE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), b.map));
  for (std::size_t k = 0; k < a.map.keyframes.size(); ++k) {
    EXPECT_TRUE(test::sameBytes(a.map.keyframes[k].world_T_camera, b.map.keyframes[k].world_T_camera)) << k;
  }
  ASSERT_EQ(a.map.points.size(), b.map.points.size());
  for (const auto& [id, point] : a.map.points) EXPECT_EQ(b.map.points.at(id).inverse_depth, point.inverse_depth) << id;
}

TEST(LocalAdjustment, AFailureLeavesTheMapAsItWas) {
  SyntheticMap synthetic(3);
  synthetic.map.keyframes[2].world_T_camera.translation.x() = std::nan("");
  const Map before = synthetic.map;
  EXPECT_FALSE(adjustLocally(test::distorted_camera, LocalAdjustmentOptions(), synthetic.map));
  EXPECT_EQ(synthetic.map.points.size(), before.points.size());
  EXPECT_TRUE(test::sameBytes(synthetic.map.keyframes[1].world_T_camera, before.keyframes[1].world_T_camera));
}

}  // namespace
}  // namespace edgeslam
