// The mapper from keyframe to keyframe: recovery, adjustment of the whole map when it is due, old parts met again, and
// culled keyframes handed out.
#include "mapping/mapper.h"

#include <gtest/gtest.h>

#include <set>

#include "map/map_check.h"
#include "unit/mapping/edge_scene.h"

namespace edgeslam::test {
namespace {

const Camera camera = testCamera(CameraModel::pinhole_radial_tangential);

TrackedFrame seen(const EdgeScene& scene, const Pose& world_T_camera, std::int64_t frame_index, KeyframeId keyframe) {
  Random random(1);
  TrackedFrame frame;
  frame.frame_index = frame_index;
  frame.time_ns = 33'333'333 * frame_index;
  frame.world_T_camera = world_T_camera;
  frame.observations = observeAll(camera, scene, world_T_camera, Sight(), random);
  frame.keyframe = keyframe;
  frame.reason = "interval";
  return frame;
}

Pose sideways(int i) { return {rotationExp({0.002 * i, -0.002 * i, 0.002 * i}), {0.05 * i, 0.01 * i, 0.01 * i}}; }

// Started as tracking does, with poses in units of the flat start's depth, before a wall 3 away.
Mapper started(MapperOptions options = {}) {
  options.initialisation.frames_between = 3;  // what is seen is exact: few do, and fast
  options.initialisation.five_point_corners = 1000;
  Mapper mapper(camera, options);
  const EdgeScene scene = framesOnAWall(21);
  for (int i = 0; i < 90 && !mapper.initialised(); ++i) {
    TrackedFrame frame = seen(scene, sideways(i), i, i == 0 ? 0 : -1);
    frame.world_T_camera.translation /= 3;
    mapper.add(frame);
  }
  return mapper;
}

// Started, and then in a map that is known: keyframes at these poses, whose world is the scene's.
Mapper mapperIn(const EdgeScene& scene, const std::vector<Pose>& poses, const MapperOptions& options = {}) {
  Mapper mapper = started(options);
  Random random(2);
  Map made = keyframesOf(camera, scene, poses, Sight(), random);
  addAllPoints(scene, made);
  mapper.correct([&](Map& map) { map = made; });
  return mapper;
}

Pose at(double x, double y = 0, double turn = 0) { return {rotationExp({0, turn, 0}), {x, y, 0}}; }

std::vector<Pose> row(int count, double spacing) {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) poses.push_back(at(spacing * k));
  return poses;
}

// A wall along x so long that its ends never are in view together.
EdgeScene longWall(double length, int count) {
  Random random(3);
  EdgeScene scene;
  for (int i = 0; i < count; ++i) {
    const double x = length * (i + uniform(random, 0, 1)) / count - 3;
    scene.points.push_back({{x, uniform(random, -2, 2), uniform(random, 4, 6)}, direction(random), i, 0, true});
  }
  return scene;
}

double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }

TEST(Mapper, TheStartGivesAMapAndPosesOfTheFramesBefore) {
  const Mapper mapper = started();
  ASSERT_TRUE(mapper.initialised());
  EXPECT_EQ(mapProblem(camera, mapper.map()), "");
  EXPECT_TRUE(mapper.view().initialised);
  EXPECT_EQ(mapper.view().origin_frame, 0);
  EXPECT_GT(mapper.earlyPoses().size(), 5U);
  EXPECT_NE(mapper.initialisationDescription(), "");
}

TEST(Mapper, AFirstFrameStartsAnew) {
  Mapper mapper = started();
  const std::uint64_t version = mapper.view().version;
  EXPECT_FALSE(mapper.add(seen(framesOnAWall(22), Pose(), 200, 0)));
  EXPECT_FALSE(mapper.initialised());
  EXPECT_TRUE(mapper.map().keyframes.empty());
  EXPECT_TRUE(mapper.map().points.empty());
  EXPECT_EQ(mapper.view().origin_frame, 200);
  EXPECT_GE(mapper.view().version, version);
  EXPECT_FALSE(mapper.adjustAll(/*at_once=*/true));
}

TEST(Mapper, TrackingsKeyframeNumbersAreKeptAndNeverGoBack) {
  const EdgeScene scene = framesOnAWall(23);
  Mapper mapper = mapperIn(scene, row(4, 0.1));
  ASSERT_TRUE(mapper.add(seen(scene, at(0.4), 100, 17)));
  EXPECT_EQ(mapper.map().keyframes.back().id, 17);
  EXPECT_EQ(mapper.map().keyframes.back().frame_index, 100);
  EXPECT_EQ(mapper.map().keyframes.back().reason, "interval");
  ASSERT_TRUE(mapper.add(seen(scene, at(0.5), 110, 9)));
  EXPECT_EQ(mapper.map().keyframes.back().id, 18);
  EXPECT_EQ(mapProblem(camera, mapper.map()), "");
  // A frame that was on its way when the map came to stand is no keyframe.
  EXPECT_FALSE(mapper.add(seen(scene, at(0.6), 120, -1)));
  EXPECT_EQ(mapper.map().keyframes.back().id, 18);
}

TEST(Mapper, EveryKeyframeGivesANewerView) {
  const EdgeScene scene = framesOnAWall(23);
  Mapper mapper = mapperIn(scene, row(4, 0.1));
  std::uint64_t version = mapper.view().version;
  for (KeyframeId id = 4; id < 8; ++id) {
    const std::optional<MapView> view = mapper.add(seen(scene, at(0.1 * id), 10 * id, id));
    ASSERT_TRUE(view);
    EXPECT_GT(view->version, version);
    EXPECT_EQ(view->keyframes.back().id, id);
    EXPECT_LT(distance(view->keyframes.back().world_T_camera, at(0.1 * id)), 1e-3);
    version = view->version;
  }
}

TEST(Mapper, RecoveryGivesTheLostFrameItsPoseAndMapsItsTracksOnce) {
  const EdgeScene scene = framesOnAWall(24);
  Mapper mapper = mapperIn(scene, {at(-0.3), at(-0.25, 0.02, 0.07), at(0)});
  // The map knows a third of the points only; the others are tracks without a depth.
  mapper.correct([](Map& map) {
    for (auto point = map.points.begin(); point != map.points.end();) {
      point = point->first % 3 == 0 ? std::next(point) : map.points.erase(point);
    }
  });
  const Map before = mapper.map();
  const std::uint64_t version = mapper.view().version;
  const Pose truth = at(0.22, -0.06, -0.05);
  TrackedFrame lost = seen(scene, truth, 70, 6);
  lost.world_T_camera = Pose{rotationExp({1, 2, 3}), {7, 8, 9}};  // is not known
  const RecoveryResult result = mapper.recover(lost);
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_LT(distance(result.world_T_camera, truth), 1e-3);
  EXPECT_LT(rotationAngle(result.world_T_camera.rotation, truth.rotation), 1e-3);

  const Map& map = mapper.map();
  EXPECT_EQ(mapProblem(camera, map), "");
  ASSERT_EQ(map.keyframes.size(), 4U);
  EXPECT_EQ(map.keyframes.back().id, 6);
  EXPECT_EQ(map.keyframes.back().frame_index, 70);
  EXPECT_EQ(map.keyframes.back().reason, "recovery");
  EXPECT_LT(distance(map.keyframes.back().world_T_camera, truth), 1e-3);
  EXPECT_GT(mapper.view().version, version);
  EXPECT_GT(map.points.size(), 2 * before.points.size());
  for (const RecoveredPoint& recovered : result.points) {
    const auto found = map.points.find(recovered.id);
    if (found == map.points.end()) continue;  // an outlier of the adjustment since
    const auto known = before.points.find(recovered.id);
    EXPECT_EQ(found->second.host, known == before.points.end() ? 2 : known->second.host) << recovered.id;
    const Eigen::Vector3d& position = scene.points[static_cast<std::size_t>(recovered.id)].position;
    EXPECT_LT((worldPosition(map, found->second) - position).norm(), 0.02) << recovered.id;
  }
  // They go on as map points, not as candidates that would be mapped a second time.
  ASSERT_TRUE(mapper.add(seen(scene, at(0.3, -0.06, -0.05), 80, 7)));
  EXPECT_EQ(mapProblem(camera, mapper.map()), "");
  int followed = 0;
  for (const RecoveredPoint& recovered : result.points) {
    const auto found = mapper.map().points.find(recovered.id);
    if (found != mapper.map().points.end() && found->second.seen_in.back() == 7) ++followed;
  }
  EXPECT_GT(followed, 100);
}

TEST(Mapper, RecoveryRefusedSaysWhyAndLeavesTheMapAlone) {
  const EdgeScene scene = framesOnAWall(24);
  const TrackedFrame lost = seen(scene, at(0.22, -0.06), 70, 6);
  Mapper none(camera, MapperOptions());
  EXPECT_FALSE(none.recover(lost).found);
  EXPECT_EQ(none.recover(lost).reason, "no map to go on from");

  MapperOptions off;
  off.recovery_enabled = false;
  EXPECT_FALSE(mapperIn(scene, row(3, 0.2), off).recover(lost).found);
  EXPECT_FALSE(mapperIn(scene, row(1, 0.2)).recover(lost).found);

  Mapper mapper = mapperIn(scene, row(3, 0.2));
  const std::uint64_t version = mapper.view().version;
  const std::size_t points = mapper.map().points.size();
  TrackedFrame few = lost;
  few.observations.resize(10);
  EXPECT_NE(mapper.recover(few).reason.find("tracks run through"), std::string::npos) << mapper.recover(few).reason;
  const RecoveryResult turned = mapper.recover(seen(scene, at(0.4, 0, 0.08), 70, 6));
  EXPECT_FALSE(turned.found);
  EXPECT_NE(turned.reason.find("too little parallax"), std::string::npos) << turned.reason;
  EXPECT_EQ(mapper.view().version, version);
  EXPECT_EQ(mapper.map().keyframes.size(), 3U);
  EXPECT_EQ(mapper.map().points.size(), points);
}

TEST(Mapper, TheWholeMapIsAdjustedEverySoManyKeyframes) {
  const EdgeScene scene = framesOnAWall(25);
  MapperOptions options;
  options.global_interval_keyframes = 5;
  options.global_interval_s = 1e6;
  Mapper mapper = mapperIn(scene, row(4, 0.05), options);
  std::vector<KeyframeId> adjusted;
  for (KeyframeId id = 4; id < 17; ++id) {
    mapper.add(seen(scene, at(0.05 * id), 10 * id, id));
    const std::uint64_t version = mapper.view().version;
    const bool changed = mapper.adjustAll(/*at_once=*/false);
    EXPECT_EQ(mapper.view().version > version, changed);
    if (changed) adjusted.push_back(id);
  }
  EXPECT_EQ(adjusted, (std::vector<KeyframeId>{5, 10, 15}));
}

TEST(Mapper, TheWholeMapIsAdjustedEverySoManySeconds) {
  const EdgeScene scene = framesOnAWall(25);
  MapperOptions options;
  options.global_interval_keyframes = 1000;
  options.global_interval_s = 4.9;
  Mapper mapper = mapperIn(scene, row(4, 0.05), options);
  std::vector<int> adjusted;  // at which second
  for (int second = 1; second < 14; ++second) {
    mapper.add(seen(scene, at(0.2 + 0.02 * second), 30 * second + 1, 3 + second));
    if (mapper.adjustAll(/*at_once=*/false)) adjusted.push_back(second);
  }
  EXPECT_EQ(adjusted, (std::vector<int>{5, 10}));
}

TEST(Mapper, TheWholeMapIsAdjustedAtOnceAndThenNotUntilItIsDueAgain) {
  const EdgeScene scene = framesOnAWall(25);
  MapperOptions options;
  options.global_interval_keyframes = 3;
  Mapper mapper = mapperIn(scene, row(3, 0.1), options);
  ASSERT_FALSE(mapper.adjustAll(false));
  mapper.correct([](Map& map) { map.keyframes[1].world_T_camera.translation.y() += 0.01; });
  EXPECT_TRUE(mapper.adjustAll(true));
  EXPECT_LT(distance(mapper.map().keyframes[1].world_T_camera, at(0.1)), 0.002) << "brought back";
  mapper.add(seen(scene, at(0.3), 30, 3));
  mapper.add(seen(scene, at(0.4), 40, 4));
  EXPECT_FALSE(mapper.adjustAll(false)) << "2 keyframes after the last time";
  mapper.add(seen(scene, at(0.5), 50, 5));
  EXPECT_TRUE(mapper.adjustAll(false));
}

TEST(Mapper, AnOldPartIsMetOnceAMeetingAndAgainLater) {
  const EdgeScene scene = longWall(80, 1600);
  MapperOptions options;
  options.old_keyframes = 8;
  Mapper mapper = mapperIn(scene, row(3, 1.5), options);
  std::vector<KeyframeId> met;
  const auto walk = [&](double from, int steps) {
    for (int step = 0; step < steps; ++step) {
      const KeyframeId id = mapper.map().keyframes.back().id + 1;
      mapper.add(seen(scene, at(from + 1.5 * step), 10 * id, id));
      if (mapper.metOldMap()) met.push_back(id);
    }
  };
  walk(4.5, 12);
  EXPECT_TRUE(met.empty()) << "a map that only goes on";
  walk(1, 3);  // keyframes 15 to 17, at the start
  EXPECT_EQ(met, (std::vector<KeyframeId>{15}));
  walk(40, 12);
  EXPECT_EQ(met.size(), 1U) << "new land";
  walk(41, 3);  // keyframes 30 to 32, where 18 was
  EXPECT_EQ(met, (std::vector<KeyframeId>{15, 30}));
}

TEST(Mapper, CulledKeyframesAreHandedOutOnceInTheirOrder) {
  const EdgeScene scene = longWall(40, 600);
  MapperOptions options;
  options.culling.recent_keyframes = 3;
  options.culling.most_keyframes = 8;
  Mapper mapper = mapperIn(scene, row(4, 0.5), options);
  EXPECT_TRUE(mapper.takeCulled().empty());
  std::set<KeyframeId> there{0, 1, 2, 3};
  for (KeyframeId id = 4; id < 30; ++id) {
    there.insert(id);
    mapper.add(seen(scene, at(0.5 * id), 10 * id, id));
    EXPECT_LE(mapper.map().keyframes.size(), 8U);
    if (id % 4 != 0) continue;  // what two keyframes or more brought about
    for (const CulledKeyframe& culled : mapper.takeCulled()) {
      EXPECT_EQ(there.erase(culled.id), 1U) << culled.id;
      EXPECT_EQ(there.count(culled.kept), 1U) << culled.kept;
    }
    EXPECT_TRUE(mapper.takeCulled().empty());
    EXPECT_EQ(there.size(), mapper.map().keyframes.size());
    for (const KeyframeId kept : there) EXPECT_TRUE(mapper.map().keyframes.contains(kept));
  }
  EXPECT_LE(there.size(), 10U);
}

}  // namespace
}  // namespace edgeslam::test
