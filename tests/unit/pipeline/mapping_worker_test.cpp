// Mapping at work: keyframes, lost frames and corrections in; updates, snapshots and reports out.
#include "pipeline/mapping_worker.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/mapping/frames_of_a_scene.h"
#include "unit/places/made_place.h"

namespace edgeslam::test {
namespace {

MappingMessage messageOf(std::int64_t number, TrackedFrame frame) {
  MappingMessage message;
  message.number = number;
  message.frame = std::move(frame);
  return message;
}

// A keyframe, or with -1 a frame before the map stands.
MappingMessage seenIn(const EdgeScene& scene, std::int64_t number, const Pose& pose, KeyframeId keyframe) {
  return messageOf(number, seen(distorted_camera, scene, pose, 10 * number, keyframe));
}

Pose sideways(int i) { return {rotationExp({0.002 * i, -0.002 * i, 0.002 * i}), {0.05 * i, 0.01 * i, 0.01 * i}}; }

// Started as tracking does it; messages from `first` on. Gives the updates.
std::vector<MapUpdate> start(MappingWorker& worker, std::int64_t first, std::int64_t& next) {
  const EdgeScene scene = framesOnAWall(21);
  std::vector<MapUpdate> updates;
  next = first;
  for (int i = 0; i < 90 && (i == 0 || !worker.mapper().initialised()); ++i) {
    MappingMessage message = seenIn(scene, next++, sideways(i), i == 0 ? 0 : -1);
    message.frame.world_T_camera.translation /= 3;
    std::optional<MapUpdate> update = worker.handle(message);
    if (update) updates.push_back(std::move(*update));
  }
  return updates;
}

Settings fastStart() {
  Settings settings;
  settings.mapping.initialisation.frames_between = 3;
  settings.mapping.initialisation.five_point_corners = 1000;
  return settings;
}

// In a map that is known; without images, so that a lost frame is found by its tracks alone.
MappingWorker workerIn(const EdgeScene& scene, const std::vector<Pose>& poses) {
  Settings settings;
  settings.relocalisation_enabled = false;
  MappingWorker worker(distorted_camera, settings);
  worker.goOnWith(mapFrom(distorted_camera, scene, poses));
  return worker;
}

MappingMessage lostIn(const EdgeScene& scene, std::int64_t number, const Pose& pose, KeyframeId keyframe) {
  MappingMessage message = seenIn(scene, number, pose, keyframe);
  message.frame.world_T_camera = Pose{rotationExp({1, 2, 3}), {7, 8, 9}};  // is not known
  message.frame.kind = FrameKind::lost;
  message.recover = true;
  message.last_good_pose = Pose();
  return message;
}

// As places makes it: of a snapshot whose map is then moved as a whole.
Correction movedBy(const Snapshot& snapshot, const Pose& move) {
  Map after = *snapshot.map;
  for (Keyframe& keyframe : after.keyframes) keyframe.world_T_camera = move * keyframe.world_T_camera;
  Correction correction;
  correction.number = snapshot.number;
  correction.change = changeOf(*snapshot.map, after);
  return correction;
}

const Pose some_move{rotationExp({0.3, -0.5, 1}), {4, 5, -6}};

TEST(MappingWorker, UpdatesAreNumberedOneByOneAndNameTheMessageTheyKnowOf) {
  MappingWorker worker(distorted_camera, fastStart());
  std::int64_t next = 0;
  std::vector<MapUpdate> updates = start(worker, 0, next);
  ASSERT_TRUE(worker.mapper().initialised());
  for (int k = 0; k < 4; ++k) {
    MappingMessage message = seenIn(framesOnAWall(21), next++, Pose(), worker.mapper().map().keyframes.back().id + 2);
    message.frame.world_T_camera = worker.mapper().map().keyframes.back().world_T_camera;
    updates.push_back(worker.handle(message).value());
    EXPECT_EQ(updates.back().answers, message.number);
  }
  for (std::size_t i = 0; i < updates.size(); ++i) {
    EXPECT_EQ(updates[i].number, static_cast<std::int64_t>(i));
    EXPECT_FALSE(updates[i].found);
    EXPECT_EQ(updates[i].not_found, "");
    if (i == 0) continue;
    EXPECT_GT(updates[i].answers, updates[i - 1].answers);
    EXPECT_GT(updates[i].view.version, updates[i - 1].view.version);
  }
  EXPECT_TRUE(updates.back().view.initialised);
}

TEST(MappingWorker, ASnapshotIsOfTheMapAfterAKeyframeAndOfNothingElse) {
  MappingWorker worker(distorted_camera, fastStart());
  EXPECT_FALSE(worker.snapshot());
  const EdgeScene wall = framesOnAWall(21);
  worker.handle(seenIn(wall, 0, sideways(0), 0));
  EXPECT_FALSE(worker.snapshot()) << "a start is no map yet";
  std::int64_t next = 0;
  start(worker, 1, next);
  ASSERT_TRUE(worker.mapper().initialised());
  const std::optional<Snapshot> first = worker.snapshot();
  ASSERT_TRUE(first) << "the map came to stand";
  EXPECT_EQ(first->number, next - 1);
  EXPECT_EQ(first->frame_index, 10 * (next - 1));
  const std::size_t keyframes = first->map->keyframes.size();

  const std::int64_t on_its_way = next++;
  EXPECT_FALSE(worker.handle(seenIn(wall, on_its_way, sideways(static_cast<int>(on_its_way) - 1), -1)));
  EXPECT_FALSE(worker.snapshot()) << "no keyframe";
  EXPECT_FALSE(worker.mapInPlace()) << "no keyframe";

  const Pose pose = worker.mapper().map().keyframes.back().world_T_camera;
  MappingMessage keyframe = seenIn(wall, next++, Pose(), 30);
  keyframe.frame.world_T_camera = pose;
  EXPECT_TRUE(worker.handle(keyframe));
  const std::optional<Snapshot> second = worker.snapshot();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->number, keyframe.number);
  EXPECT_EQ(second->map->keyframes.back().id, 30);
  EXPECT_EQ(first->map->keyframes.size(), keyframes) << "a value, that stays as it was";

  const std::optional<Snapshot> in_place = worker.mapInPlace();
  ASSERT_TRUE(in_place);
  EXPECT_EQ(in_place->number, second->number);
  EXPECT_EQ(in_place->frame_index, second->frame_index);
  EXPECT_EQ(in_place->map.get(), &worker.mapper().map());
}

TEST(MappingWorker, ALostFrameIsRecoveredAsAKeyframe) {
  const EdgeScene scene = framesOnAWall(24);
  MappingWorker worker = workerIn(scene, {at(-0.3), at(-0.25, 0.02, 0.07), at(0)});
  const Pose truth = at(0.22, -0.06, -0.05);
  const std::optional<MapUpdate> update = worker.handle(lostIn(scene, 7, truth, 6));
  ASSERT_TRUE(update);
  EXPECT_EQ(update->answers, 7);
  EXPECT_EQ(update->not_found, "");
  ASSERT_TRUE(update->found);
  EXPECT_EQ(update->found->frame_index, 70);
  EXPECT_EQ(update->found->how, TrackingState::recovered);
  EXPECT_LT(distance(update->found->world_T_camera, truth), 1e-3);
  EXPECT_GT(update->found->covariance.diagonal().minCoeff(), 0);
  EXPECT_TRUE(update->found->points.empty()) << "its tracks go on";
  EXPECT_EQ(update->view.keyframes.back().id, 6);
  const std::optional<Snapshot> snapshot = worker.snapshot();
  ASSERT_TRUE(snapshot);
  EXPECT_EQ(snapshot->number, 7);

  const std::vector<MappingReport> reports = worker.takeReports();
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0].frame_index, 70);
  ASSERT_TRUE(reports[0].found);
  EXPECT_EQ(reports[0].found->how, TrackingState::recovered);
  EXPECT_EQ(reports[0].found->reference, 6);
  EXPECT_LT(reports[0].found->reference_T_camera.translation.norm(), 1e-12) << "it is that keyframe";
  EXPECT_EQ(reports[0].events.size(), 1U);
  EXPECT_TRUE(worker.takeReports().empty());
}

TEST(MappingWorker, ALostFrameThatIsNotFoundIsAnsweredWithTheReason) {
  const EdgeScene scene = framesOnAWall(24);
  MappingWorker worker = workerIn(scene, row(3, 0.2));
  worker.handle(seenIn(scene, 2, at(0.5), 5));
  worker.takeReports();
  ASSERT_TRUE(worker.snapshot());
  MappingMessage lost = lostIn(scene, 3, at(0.6), 6);
  lost.frame.observations.resize(10);
  const std::optional<MapUpdate> update = worker.handle(lost);
  ASSERT_TRUE(update);
  EXPECT_EQ(update->answers, 3);
  EXPECT_FALSE(update->found);
  EXPECT_NE(update->not_found.find("tracks run through"), std::string::npos) << update->not_found;
  EXPECT_TRUE(worker.takeReports().empty());
  EXPECT_EQ(worker.mapper().map().keyframes.size(), 4U);
  EXPECT_FALSE(worker.snapshot()) << "nothing new for places";
  // The reason is that frame's.
  EXPECT_EQ(worker.handle(seenIn(scene, 4, at(0.6), 7))->not_found, "");
}

TEST(MappingWorker, ALostFrameBeforeAnyMapIsAnsweredToo) {
  MappingWorker worker(distorted_camera, Settings());
  const std::optional<MapUpdate> update = worker.handle(lostIn(framesOnAWall(24), 2, at(0), 1));
  ASSERT_TRUE(update);
  EXPECT_EQ(update->answers, 2);
  EXPECT_FALSE(update->found);
}

TEST(MappingWorker, WhatWasFoundFollowsTheMapThroughLaterCorrections) {
  const EdgeScene scene = framesOnAWall(24);
  MappingWorker worker = workerIn(scene, {at(-0.5), at(-0.3), at(-0.25, 0.02, 0.07)});
  worker.handle(seenIn(scene, 1, at(0), 3));
  const Snapshot snapshot = worker.snapshot().value();
  const MapUpdate found = worker.handle(lostIn(scene, 2, at(0.22, -0.06, -0.05), 6)).value();
  ASSERT_TRUE(found.found) << found.not_found;
  Pose should_be = found.found->world_T_camera;
  for (int i = 1; i <= 2; ++i) {
    // Twice: the second one as from a snapshot after the first.
    const Snapshot latest = i == 1 ? snapshot : Snapshot{2, 20, std::make_shared<const Map>(worker.mapper().map())};
    const Map before = worker.mapper().map();
    const std::optional<MapUpdate> update = worker.apply(movedBy(latest, some_move));
    ASSERT_TRUE(update);
    EXPECT_EQ(update->number, found.number + i);
    EXPECT_EQ(update->answers, 2) << "a correction answers no message";
    ASSERT_TRUE(update->found);
    EXPECT_EQ(update->found->frame_index, 20);
    EXPECT_EQ(update->found->how, TrackingState::recovered);
    if (i == 2) should_be = some_move * should_be;
    if (i == 1) {
      // The keyframe is newer than the snapshot: it keeps to the snapshot's latest one.
      const Pose latest_T_found = before.keyframes[3].world_T_camera.inverse() * should_be;
      should_be = worker.mapper().map().keyframes[3].world_T_camera * latest_T_found;
    }
    EXPECT_LT(distance(update->found->world_T_camera, should_be), 1e-6);
    EXPECT_LT(rotationAngle(update->found->world_T_camera.rotation, should_be.rotation), 1e-6);
    EXPECT_LT(distance(update->view.keyframes[6].world_T_camera, update->found->world_T_camera), 1e-9);
  }
  EXPECT_FALSE(worker.handle(seenIn(scene, 3, some_move * some_move * at(0.3), 7))->found) << "tracking went on";
}

TEST(MappingWorker, ACorrectionWithoutAChangeIsReportedOnly) {
  const EdgeScene scene = framesOnAWall(24);
  MappingWorker worker = workerIn(scene, row(3, 0.2));
  worker.handle(seenIn(scene, 1, at(0.6), 3));
  const std::uint64_t version = worker.mapper().view().version;
  Correction correction;
  correction.number = 1;
  EXPECT_FALSE(worker.apply(correction));
  EXPECT_TRUE(worker.takeReports().empty());
  correction.events = {"loop of keyframe 3 to keyframe 0 refused: too few points"};
  EXPECT_FALSE(worker.apply(correction));
  const std::vector<MappingReport> reports = worker.takeReports();
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports[0].events, correction.events);
  EXPECT_FALSE(reports[0].loop);
  EXPECT_EQ(worker.mapper().view().version, version);
}

TEST(MappingWorker, AClosedLoopIsReported) {
  const EdgeScene scene = framesOnAWall(24);
  MappingWorker worker = workerIn(scene, row(3, 0.2));
  worker.handle(seenIn(scene, 1, at(0.6), 3));
  Correction correction = movedBy(worker.snapshot().value(), some_move);
  correction.loop.emplace().how = "by its looks";
  correction.loop->keyframe = 3;
  EXPECT_TRUE(worker.apply(correction));
  const std::vector<MappingReport> reports = worker.takeReports();
  ASSERT_EQ(reports.size(), 1U);
  ASSERT_TRUE(reports[0].loop);
  EXPECT_EQ(reports[0].loop->how, "by its looks");
  EXPECT_EQ(reports[0].loop->keyframe, 3);
  EXPECT_LT(distance(worker.mapper().map().keyframes[0].world_T_camera, some_move * at(0)), 1e-9);
}

TEST(MappingWorker, ACorrectionOfAMapThatWasGivenUpIsIgnored) {
  MappingWorker worker(distorted_camera, fastStart());
  std::int64_t next = 0;
  start(worker, 0, next);
  Correction correction = movedBy(worker.snapshot().value(), some_move);
  correction.events = {"an old part of the map is met again by its points"};
  // Tracking starts anew.
  worker.handle(seenIn(framesOnAWall(22), next++, Pose(), 0));
  EXPECT_FALSE(worker.apply(correction));
  EXPECT_TRUE(worker.mapper().map().keyframes.empty());
  start(worker, next, next);
  ASSERT_TRUE(worker.mapper().initialised());
  const Map before = worker.mapper().map();
  EXPECT_FALSE(worker.apply(correction));
  EXPECT_TRUE(worker.takeReports().empty());
  for (const Keyframe& keyframe : before.keyframes) {
    EXPECT_EQ(worker.mapper().map().keyframes[keyframe.id].world_T_camera.translation,
              keyframe.world_T_camera.translation);
  }
  EXPECT_TRUE(worker.apply(movedBy(worker.snapshot().value(), some_move))) << "of this map it is taken";
}

TEST(MappingWorker, CulledKeyframesAreReported) {
  const EdgeScene scene = longWall(40, 600);
  Settings settings;
  settings.mapping.culling.recent_keyframes = 3;
  settings.mapping.culling.most_keyframes = 8;
  MappingWorker worker(distorted_camera, settings);
  worker.goOnWith(mapFrom(distorted_camera, scene, row(4, 0.5)));
  std::size_t culled = 0;
  for (KeyframeId id = 4; id < 15; ++id) {
    worker.handle(seenIn(scene, id, at(0.5 * id), id));
    for (const MappingReport& report : worker.takeReports()) {
      EXPECT_EQ(report.frame_index, 10 * id);
      culled += report.culled.size();
    }
  }
  EXPECT_EQ(culled + worker.mapper().map().keyframes.size(), 15U);
  EXPECT_GE(culled, 7U);
}

// A part of a room, with images.
const Map& place() {
  static const Map map = [] {
    std::vector<Pose> poses = turnAround(36, 0);
    poses.resize(6);
    return makePlace(7, placeCamera(), poses);
  }();
  return map;
}

MappingMessage lostInRoom(std::int64_t number, std::uint64_t room, const Pose& pose) {
  MappingMessage message;
  message.number = number;
  message.frame.kind = FrameKind::lost;
  message.frame.frame_index = 10 * number;
  message.frame.keyframe = 100;
  auto images = std::make_shared<FrameImages>();
  images->pyramid = buildPyramid(renderRoom(room, placeCamera(), pose), 4);
  message.edges = std::make_shared<EdgeMap>(detectEdges(images->pyramid.levels[0], {}));
  message.frame.images = std::move(images);
  return message;
}

TEST(MappingWorker, ALostFrameIsFoundAgainstTheWholeMap) {
  MappingWorker worker(placeCamera(), Settings());
  worker.goOnWith(place());
  Vector6d update;
  update << 0.1, 0.05, 0, 0, 0.03, 0;
  const Pose truth = retract(place().keyframes[3].world_T_camera, update);
  const MapUpdate answer = worker.handle(lostInRoom(0, 7, truth)).value();
  ASSERT_TRUE(answer.found) << answer.not_found;
  EXPECT_EQ(answer.not_found, "");
  EXPECT_EQ(answer.found->how, TrackingState::relocalised);
  EXPECT_EQ(answer.found->frame_index, 0);
  EXPECT_LT(distance(answer.found->world_T_camera, truth), 0.02);
  EXPECT_GT(answer.found->covariance.diagonal().minCoeff(), 0);
  EXPECT_GE(answer.found->points.size(), 30U);
  for (const FoundAgain& point : answer.found->points) EXPECT_TRUE(findPoint(answer.view, point.point)) << point.point;
  EXPECT_FALSE(worker.snapshot()) << "the map is as it was";
  const std::vector<MappingReport> reports = worker.takeReports();
  ASSERT_EQ(reports.size(), 1U);
  ASSERT_TRUE(reports[0].found);
  const Pose& reference = place().keyframes[reports[0].found->reference].world_T_camera;
  EXPECT_LT(distance(reference * reports[0].found->reference_T_camera, answer.found->world_T_camera), 1e-9);

  const Snapshot snapshot{0, 0, std::make_shared<const Map>(worker.mapper().map())};
  const std::optional<MapUpdate> moved = worker.apply(movedBy(snapshot, some_move));
  ASSERT_TRUE(moved && moved->found);
  EXPECT_LT(distance(moved->found->world_T_camera, some_move * answer.found->world_T_camera), 1e-9);
  EXPECT_EQ(moved->found->points.size(), answer.found->points.size());

  const MapUpdate other = worker.handle(lostInRoom(1, 8, truth)).value();
  EXPECT_FALSE(other.found) << "another room";
  EXPECT_NE(other.not_found, "");
}

TEST(MappingWorker, TheViewIsAroundTheFrameThatWasFound) {
  Settings settings;
  settings.mapping.view.latest_keyframes = 1;
  settings.mapping.view.near_keyframes = 0;
  MappingWorker worker(placeCamera(), settings);
  worker.goOnWith(place());
  const MapUpdate answer = worker.handle(lostInRoom(0, 7, place().keyframes[0].world_T_camera)).value();
  ASSERT_TRUE(answer.found) << answer.not_found;
  const KeyframeId reference = worker.takeReports().at(0).found->reference;
  ASSERT_LT(reference, 3);
  for (const auto& [id, point] : place().points) {
    const bool seen = point.host == reference || std::count(point.seen_in.begin(), point.seen_in.end(), reference) > 0;
    EXPECT_EQ(findPoint(answer.view, id) != nullptr, seen) << id;
  }
}

// The map of a frozen run, shown around the keyframe that tracking asks for.
TEST(MappingWorker, AFrozenMapIsShownAroundAnyKeyframeAndStaysAsItIs) {
  Settings settings;
  settings.tracking.map_is_frozen = true;
  settings.mapping.view.latest_keyframes = 1;
  settings.mapping.view.near_keyframes = 0;
  MappingWorker worker(placeCamera(), settings);
  worker.goOnWith(place());
  std::uint64_t version = worker.mapper().view().version;
  for (const KeyframeId centre : {0, 4, 2}) {
    MappingMessage message;
    message.number = centre;
    message.frame.kind = FrameKind::elsewhere;
    message.frame.keyframe = centre;
    const std::optional<MapUpdate> update = worker.handle(message);
    ASSERT_TRUE(update);
    EXPECT_EQ(update->view.centre, centre);
    EXPECT_GT(update->view.version, version) << "or tracking would not take it";
    version = update->view.version;
    EXPECT_FALSE(update->found);
    EXPECT_FALSE(worker.hasNewKeyframe());
    EXPECT_FALSE(worker.snapshot()) << "places has nothing to do";
    for (const ViewPoint& point : update->view.points) {
      const MapPoint& mapped = place().points.at(point.id);
      EXPECT_TRUE(mapped.host == centre || std::count(mapped.seen_in.begin(), mapped.seen_in.end(), centre) > 0);
    }
  }
  EXPECT_TRUE(worker.takeReports().empty());
  EXPECT_EQ(worker.mapper().map().keyframes.size(), place().keyframes.size());
  EXPECT_EQ(worker.mapper().map().points.size(), place().points.size());
}

}  // namespace
}  // namespace edgeslam::test
