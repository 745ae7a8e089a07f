// The mapper from keyframe to keyframe: the start, recovery, changes of the map as a whole, and culled keyframes handed
// out.
#include "mapping/mapper.h"

#include <gtest/gtest.h>

#include <set>

#include "map/map_check.h"
#include "map/worlds.h"
#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam::test {
namespace {

TrackedFrame trackedFrame(const EdgeScene& scene, const Pose& world_T_camera, std::int64_t frame_index,
                          KeyframeId keyframe) {
  return test::seen(distorted_camera, scene, world_T_camera, frame_index, keyframe);
}

Pose pastTheWall(int i) { return {rotationExp({0.002 * i, -0.002 * i, 0.002 * i}), {0.05 * i, 0.01 * i, 0.01 * i}}; }

// Started as tracking does, with poses in units of the flat start's depth, before a wall 3 away.
Mapper started(MapperOptions options = {}) {
  options.initialisation.frames_between = 3;  // what is seen is exact: few do, and fast
  options.initialisation.five_point_corners = 1000;
  Mapper mapper(distorted_camera, options);
  const EdgeScene scene = framesOnAWall(21);
  for (int i = 0; i < 90 && !mapper.initialised(); ++i) {
    TrackedFrame frame = trackedFrame(scene, pastTheWall(i), i, i == 0 ? 0 : -1);
    frame.world_T_camera.translation /= 3;
    mapper.add(frame);
  }
  return mapper;
}

// In a map that is known: keyframes at these poses, whose world is the scene's.
Mapper mapperIn(const EdgeScene& scene, const std::vector<Pose>& poses, const MapperOptions& options = {}) {
  Mapper mapper(distorted_camera, options);
  mapper.goOnWith(mapFrom(distorted_camera, scene, poses));
  return mapper;
}

TEST(Mapper, TheStartGivesAMapAndPosesOfTheFramesBefore) {
  const Mapper mapper = started();
  ASSERT_TRUE(mapper.initialised());
  EXPECT_EQ(mapProblem(distorted_camera, mapper.map()), "");
  EXPECT_TRUE(mapper.view().initialised);
  EXPECT_EQ(mapper.view().origin_frame, 0);
  EXPECT_GT(mapper.earlyPoses().size(), 5U);
  EXPECT_NE(mapper.initialisationDescription(), "");
}

TEST(Mapper, AFirstFrameStartsAnew) {
  Mapper mapper = started();
  const std::uint64_t version = mapper.view().version;
  EXPECT_FALSE(mapper.add(trackedFrame(framesOnAWall(22), Pose(), 200, 0)));
  EXPECT_FALSE(mapper.initialised());
  EXPECT_TRUE(mapper.map().keyframes.empty());
  EXPECT_TRUE(mapper.map().points.empty());
  EXPECT_EQ(mapper.view().origin_frame, 200);
  EXPECT_GE(mapper.view().version, version);
  EXPECT_FALSE(mapper.recover(trackedFrame(framesOnAWall(22), Pose(), 201, 1)).found);
}

TEST(Mapper, TrackingsKeyframeNumbersAreKeptAndNeverGoBack) {
  const EdgeScene scene = framesOnAWall(23);
  Mapper mapper = mapperIn(scene, row(4, 0.1));
  ASSERT_TRUE(mapper.add(trackedFrame(scene, at(0.4), 100, 17)));
  EXPECT_EQ(mapper.map().keyframes.back().id, 17);
  EXPECT_EQ(mapper.map().keyframes.back().frame_index, 100);
  EXPECT_EQ(mapper.map().keyframes.back().reason, "interval");
  ASSERT_TRUE(mapper.add(trackedFrame(scene, at(0.5), 110, 9)));
  EXPECT_EQ(mapper.map().keyframes.back().id, 18);
  EXPECT_EQ(mapProblem(distorted_camera, mapper.map()), "");
}

TEST(Mapper, AFrameThatWasOnItsWayWhenTheMapCameToStandIsNoKeyframe) {
  Mapper mapper = started();
  ASSERT_TRUE(mapper.initialised());
  const KeyframeId latest = mapper.map().keyframes.back().id;
  const std::uint64_t version = mapper.view().version;
  const std::int64_t next = mapper.map().keyframes.back().frame_index + 1;
  const std::size_t early_poses = mapper.earlyPoses().size();
  EXPECT_FALSE(mapper.add(trackedFrame(framesOnAWall(21), pastTheWall(static_cast<int>(next)), next, -1)));
  EXPECT_EQ(mapper.map().keyframes.back().id, latest);
  EXPECT_EQ(mapper.view().version, version);
  EXPECT_EQ(mapper.earlyPoses().size(), early_poses + 1) << "but it has a pose";
}

Pose slowly(int i) { return {rotationExp({0.002 * i, -0.002 * i, 0.002 * i}), {0.008 * i, 0.002 * i, 0.002 * i}}; }

// Frame 3 is kept as another start's first, with twice as many points. From frame 6 on the first one's are gone, and
// tracking goes on from frame 3.
Mapper startedFromSpare(int frames) {
  MapperOptions options;
  options.initialisation.frames_between = 3;
  options.initialisation.five_point_corners = 1000;
  Mapper mapper(distorted_camera, options);
  const EdgeScene scene = framesOnAWall(21);
  for (int i = 0; i < frames; ++i) {
    const Pose against = i < 6 ? Pose() : slowly(3);
    TrackedFrame frame = trackedFrame(scene, slowly(i), i, i == 0 || i == 3 ? 0 : -1);
    frame.world_T_camera = against.inverse() * frame.world_T_camera;
    frame.world_T_camera.translation /= 3;
    if (i > 0) frame.kind = i == 3 ? FrameKind::spare : FrameKind::start;
    frame.start = i < 6 ? 0 : 3;
    std::vector<PointObservation>& seen = frame.observations;
    const auto isGone = [i](const PointObservation& o) {
      const bool is_of_first = o.point % 2 == 0;
      return i < 3 ? !is_of_first : i >= 6 && is_of_first;
    };
    seen.erase(std::remove_if(seen.begin(), seen.end(), isGone), seen.end());
    mapper.add(frame);
  }
  return mapper;
}

TEST(Mapper, AStartGoesOnFromItsSpareFrame) {
  const Mapper waiting = startedFromSpare(6);
  EXPECT_FALSE(waiting.initialised());
  EXPECT_EQ(waiting.view().origin_frame, 0);
  EXPECT_EQ(startedFromSpare(7).view().origin_frame, 3);
  const Mapper mapper = startedFromSpare(60);
  ASSERT_TRUE(mapper.initialised());
  EXPECT_EQ(mapProblem(distorted_camera, mapper.map()), "");
  EXPECT_EQ(mapper.map().keyframes.front().frame_index, 3);
  EXPECT_EQ(mapper.map().keyframes.front().id, 0);
  EXPECT_EQ(mapper.earlyPoses().front().frame_index, 3);
  // Up to a scale, the path is that of the camera.
  const Keyframe& last = mapper.map().keyframes.back();
  const Pose truth = slowly(3).inverse() * slowly(static_cast<int>(last.frame_index));
  EXPECT_LT(rotationAngle(last.world_T_camera.rotation, truth.rotation), 0.01);
  EXPECT_GT(last.world_T_camera.translation.normalized().dot(truth.translation.normalized()), 0.999);
}

// Tracking gave the start up before it heard that its map stands.
TEST(Mapper, AStartThatStoodTooLateGivesWayToItsSpareFrame) {
  Mapper mapper(distorted_camera, MapperOptions());
  const EdgeScene scene = framesOnAWall(21);
  int i = 0;
  for (; i < 90 && !mapper.initialised(); ++i) {
    TrackedFrame frame = trackedFrame(scene, pastTheWall(i), i, i == 0 || i == 2 ? 0 : -1);
    frame.world_T_camera.translation /= 3;
    frame.kind = i == 0 ? FrameKind::first : i == 2 ? FrameKind::spare : FrameKind::start;
    frame.start = 0;
    mapper.add(frame);
  }
  ASSERT_TRUE(mapper.initialised());
  TrackedFrame frame = trackedFrame(scene, pastTheWall(i), i, -1);
  frame.start = 2;
  mapper.add(frame);
  EXPECT_EQ(mapper.view().origin_frame, 2);
  if (mapper.initialised()) {
    EXPECT_EQ(mapper.map().keyframes.front().frame_index, 2);
  }
  EXPECT_EQ(mapper.startsGivenUp(), 1U);
}

// Feeds frames of another place until a map of it stands; its first keyframe gets this number.
void startElsewhere(Mapper& mapper, std::int64_t first_frame, KeyframeId first_keyframe) {
  const EdgeScene scene = framesOnAWall(25);
  for (int i = 0; i < 90 && (i == 0 || !mapper.initialised()); ++i) {
    TrackedFrame frame = trackedFrame(scene, pastTheWall(i), first_frame + i, i == 0 ? first_keyframe : -1);
    frame.kind = i == 0 ? FrameKind::first : FrameKind::start;
    for (PointObservation& observation : frame.observations) observation.point += 1'000'000;
    frame.world_T_camera.translation /= 3;
    mapper.add(frame);
  }
}

TEST(Mapper, AStartAfterTheMapStandsBeginsAWorldBesideIt) {
  Mapper mapper = started();
  const Map first = mapper.map();
  startElsewhere(mapper, 500, 40);
  ASSERT_TRUE(mapper.initialised());
  EXPECT_EQ(mapper.world(), 1);
  EXPECT_EQ(worldsOf(mapper.map()), (std::vector<int>{0, 1}));
  EXPECT_EQ(keyframesOf(mapper.map(), 0).size(), first.keyframes.size());
  EXPECT_EQ(keyframesOf(mapper.map(), 1).front(), 40);
  EXPECT_EQ(mapProblem(distorted_camera, mapper.map()), "");
  const MapView view = mapper.view();
  EXPECT_EQ(view.world, 1);
  EXPECT_EQ(view.keyframes.front().id, 40) << "tracking sees its own world";
  EXPECT_EQ(view.latest_keyframe, mapper.map().keyframes.back().id);
  for (const ViewPoint& point : view.points) EXPECT_GE(point.host, 40);
  std::set<int> worlds_of_early_poses;
  for (const EarlyPose& early : mapper.earlyPoses()) worlds_of_early_poses.insert(early.world);
  EXPECT_EQ(worlds_of_early_poses, (std::set<int>{0, 1}));
}

TEST(Mapper, FoundAgainInTheOldWorldItGoesOnThereAndForgetsTheStart) {
  Mapper mapper = started();
  const KeyframeId latest = mapper.map().keyframes.back().id;
  TrackedFrame first = trackedFrame(framesOnAWall(25), Pose(), 500, 40);
  first.kind = FrameKind::first;
  mapper.add(first);
  EXPECT_FALSE(mapper.initialised());
  mapper.goBackTo(latest);
  EXPECT_TRUE(mapper.initialised());
  EXPECT_EQ(mapper.view().keyframes.back().id, latest);
  // What of the start was on its way says nothing any more.
  EXPECT_FALSE(mapper.add(trackedFrame(framesOnAWall(25), pastTheWall(1), 501, -1)));
  EXPECT_EQ(worldsOf(mapper.map()), std::vector<int>{0});
  TrackedFrame next = trackedFrame(framesOnAWall(21), pastTheWall(30), 510, 41);
  next.world_T_camera.translation /= 3;
  EXPECT_TRUE(mapper.add(next));
  EXPECT_EQ(mapper.map().keyframes.back().id, 41);
  EXPECT_EQ(mapper.map().keyframes.back().world, 0);
}

// Tracking was found in the old world before it heard of the new one, and gives its numbers to others.
TEST(Mapper, AWorldThatStoodTooLateForTrackingIsForgotten) {
  Mapper mapper = started();
  startElsewhere(mapper, 500, 40);
  ASSERT_EQ(mapper.world(), 1);
  TrackedFrame next = trackedFrame(framesOnAWall(21), pastTheWall(30), 600, 41);
  next.world_T_camera.translation /= 3;
  next.world = 0;
  EXPECT_TRUE(mapper.add(next));
  EXPECT_EQ(worldsOf(mapper.map()), std::vector<int>{0});
  EXPECT_EQ(mapper.map().keyframes.back().id, 41);
  EXPECT_EQ(mapper.startsGivenUp(), 1U);
  startElsewhere(mapper, 700, 50);
  EXPECT_EQ(mapper.world(), 1) << "its number was never given out";
}

TEST(Mapper, WhatIsTrackedInAWorldThatWasJoinedIsPutIntoTheOther) {
  Mapper mapper = started();
  startElsewhere(mapper, 500, 40);
  ASSERT_EQ(mapper.world(), 1);
  const Map before = mapper.map();
  const WorldJoin join{1, 0, {2, Eigen::Quaterniond(rotationExp({0, 0.4, 0})), {1, 2, 3}}};
  Map after = before;
  joinWorlds(join, after);
  std::vector<EarlyPose> early_before = mapper.earlyPoses();
  mapper.apply(changeOf(before, after, join));
  EXPECT_EQ(mapper.world(), 0);
  EXPECT_EQ(worldsOf(mapper.map()), std::vector<int>{0});
  const std::vector<EarlyPose> early_after = mapper.earlyPoses();
  ASSERT_EQ(early_after.size(), early_before.size());
  for (std::size_t i = 0; i < early_after.size(); ++i) {
    const Pose& was = early_before[i].world_T_camera;
    const Pose should_be = early_before[i].world == 0 ? was : moved(join.to_S_from, was);
    EXPECT_LT(distance(early_after[i].world_T_camera, should_be), 1e-9) << i;
  }
  TrackedFrame next = trackedFrame(framesOnAWall(25), pastTheWall(30), 600, 90);
  for (PointObservation& observation : next.observations) observation.point += 1'000'000;
  next.world_T_camera = before.keyframes.back().world_T_camera;
  next.world = 1;
  EXPECT_TRUE(mapper.add(next));
  EXPECT_EQ(mapper.map().keyframes.back().world, 0);
}

TEST(Mapper, EveryKeyframeGivesANewerView) {
  const EdgeScene scene = framesOnAWall(23);
  Mapper mapper = mapperIn(scene, row(4, 0.1));
  std::uint64_t version = mapper.view().version;
  for (KeyframeId id = 4; id < 8; ++id) {
    ASSERT_TRUE(mapper.add(trackedFrame(scene, at(0.1 * id), 10 * id, id)));
    const MapView view = mapper.view();
    EXPECT_GT(view.version, version);
    EXPECT_EQ(view.keyframes.back().id, id);
    EXPECT_LT(distance(view.keyframes.back().world_T_camera, at(0.1 * id)), 1e-3);
    version = view.version;
  }
}

TEST(Mapper, AChangeOfTheWholeMapIsAppliedToWhatCameSinceToo) {
  const EdgeScene scene = framesOnAWall(23);
  Mapper mapper = mapperIn(scene, row(4, 0.1));
  const Map copy = mapper.map();
  ASSERT_TRUE(mapper.add(trackedFrame(scene, at(0.4), 40, 4)));
  const Map before = mapper.map();
  const std::uint64_t version = mapper.view().version;
  const Pose move{rotationExp({0.1, -0.2, 0.3}), {1, 2, 3}};
  Map corrected = copy;
  for (Keyframe& keyframe : corrected.keyframes) keyframe.world_T_camera = move * keyframe.world_T_camera;
  mapper.apply(changeOf(copy, corrected));
  EXPECT_GT(mapper.view().version, version);
  EXPECT_EQ(mapProblem(distorted_camera, mapper.map()), "");
  for (const Keyframe& keyframe : mapper.map().keyframes) {
    const Pose& was = (keyframe.id < 4 ? copy : before).keyframes[keyframe.id].world_T_camera;
    EXPECT_LT(distance(keyframe.world_T_camera, move * was), 1e-9) << keyframe.id;
  }
  // And mapping goes on in it.
  ASSERT_TRUE(mapper.add(trackedFrame(scene, move * at(0.5), 50, 5)));
  EXPECT_EQ(mapper.view().keyframes.back().id, 5);
}

TEST(Mapper, RecoveryGivesTheLostFrameItsPoseAndMapsItsTracksOnce) {
  const EdgeScene scene = framesOnAWall(24);
  Map before = mapFrom(distorted_camera, scene, {at(-0.3), at(-0.25, 0.02, 0.07), at(0)});
  // The map knows a third of the points only; the others are tracks without a depth.
  for (auto point = before.points.begin(); point != before.points.end();) {
    point = point->first % 3 == 0 ? std::next(point) : before.points.erase(point);
  }
  Mapper mapper(distorted_camera, MapperOptions());
  mapper.goOnWith(before);
  const std::uint64_t version = mapper.view().version;
  const Pose truth = at(0.22, -0.06, -0.05);
  TrackedFrame lost = trackedFrame(scene, truth, 70, 6);
  lost.world_T_camera = Pose{rotationExp({1, 2, 3}), {7, 8, 9}};  // is not known
  const RecoveryResult result = mapper.recover(lost);
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_LT(distance(result.world_T_camera, truth), 1e-3);
  EXPECT_LT(rotationAngle(result.world_T_camera.rotation, truth.rotation), 1e-3);

  const Map& map = mapper.map();
  EXPECT_EQ(mapProblem(distorted_camera, map), "");
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
  ASSERT_TRUE(mapper.add(trackedFrame(scene, at(0.3, -0.06, -0.05), 80, 7)));
  EXPECT_EQ(mapProblem(distorted_camera, mapper.map()), "");
  int followed = 0;
  for (const RecoveredPoint& recovered : result.points) {
    const auto found = mapper.map().points.find(recovered.id);
    if (found != mapper.map().points.end() && found->second.seen_in.back() == 7) ++followed;
  }
  EXPECT_GT(followed, 100);
}

TEST(Mapper, RecoveryRefusedSaysWhyAndLeavesTheMapAlone) {
  const EdgeScene scene = framesOnAWall(24);
  const TrackedFrame lost = trackedFrame(scene, at(0.22, -0.06), 70, 6);
  Mapper none(distorted_camera, MapperOptions());
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
  const RecoveryResult turned = mapper.recover(trackedFrame(scene, at(0.4, 0, 0.08), 70, 6));
  EXPECT_FALSE(turned.found);
  EXPECT_NE(turned.reason.find("too little parallax"), std::string::npos) << turned.reason;
  EXPECT_EQ(mapper.view().version, version);
  EXPECT_EQ(mapper.map().keyframes.size(), 3U);
  EXPECT_EQ(mapper.map().points.size(), points);
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
    mapper.add(trackedFrame(scene, at(0.5 * id), 10 * id, id));
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
