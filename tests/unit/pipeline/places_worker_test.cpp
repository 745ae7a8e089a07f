// Places: when the whole map is adjusted, when an old part of it is met again, and what is handed back.
#include "pipeline/places_worker.h"

#include <gtest/gtest.h>

#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam::test {
namespace {

Settings settingsOf(const PlacesOptions& places) {
  Settings settings;
  settings.places = places;
  return settings;
}

// Adjusted as a whole every so often, and never for an old part that is met.
PlacesOptions dueEvery(int keyframes, double seconds) {
  PlacesOptions options;
  options.old_keyframes = 1000;
  options.global_interval_keyframes = keyframes;
  options.global_interval_s = seconds;
  return options;
}

PlacesOptions neverDue(int old_keyframes) {
  PlacesOptions options = dueEvery(100'000, 1e9);
  options.old_keyframes = old_keyframes;
  return options;
}

// The map as it was after the first `count` keyframes of a way: each sees what it sees, and nothing is wrong.
Map grown(const EdgeScene& scene, const std::vector<Pose>& way, std::size_t count, std::int64_t interval_ns = 0,
          std::int64_t first_frame = 0) {
  Map map = mapFrom(distorted_camera, scene, {way.begin(), way.begin() + static_cast<std::ptrdiff_t>(count)});
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.frame_index += first_frame;
    keyframe.time_ns = interval_ns * keyframe.id;
  }
  return map;
}

// Numbers as a run gives them: of messages, of which most are no keyframes.
Snapshot snapshotOf(Map map) {
  Snapshot snapshot;
  snapshot.number = 3 * map.keyframes.back().id + 1;
  snapshot.frame_index = map.keyframes.back().frame_index;
  snapshot.map = std::make_shared<const Map>(std::move(map));
  return snapshot;
}

// What became of the snapshots after keyframes `first` to `last` of a way.
std::vector<Correction> corrections(PlacesWorker& places, const EdgeScene& scene, const std::vector<Pose>& way,
                                    KeyframeId first, KeyframeId last, std::int64_t interval_ns = 0) {
  std::vector<Correction> all;
  for (KeyframeId id = first; id <= last; ++id) {
    const Snapshot snapshot = snapshotOf(grown(scene, way, static_cast<std::size_t>(id) + 1, interval_ns));
    all.push_back(places.work(snapshot));
    EXPECT_EQ(all.back().number, snapshot.number);
  }
  return all;
}

std::vector<KeyframeId> changedAt(const std::vector<Correction>& corrections, KeyframeId first) {
  std::vector<KeyframeId> changed;
  for (const Correction& correction : corrections) {
    if (!correction.change.empty()) changed.push_back(first + static_cast<KeyframeId>(&correction - &corrections[0]));
  }
  return changed;
}

TEST(PlacesWorker, TheWholeMapIsAdjustedEverySoManyKeyframes) {
  const EdgeScene scene = framesOnAWall(25);
  PlacesWorker places(distorted_camera, settingsOf(dueEvery(5, 1e6)));
  const auto done = corrections(places, scene, row(17, 0.05), 3, 16);
  EXPECT_EQ(changedAt(done, 3), (std::vector<KeyframeId>{8, 13}));
  for (const Correction& correction : done) {
    EXPECT_TRUE(correction.events.empty());
    EXPECT_FALSE(correction.loop);
  }
}

TEST(PlacesWorker, TheWholeMapIsAdjustedEverySoManySeconds) {
  const EdgeScene scene = framesOnAWall(25);
  PlacesWorker places(distorted_camera, settingsOf(dueEvery(1000, 4.9)));
  const auto done = corrections(places, scene, row(17, 0.02), 3, 16, /*interval_ns=*/1'000'000'000);
  EXPECT_EQ(changedAt(done, 3), (std::vector<KeyframeId>{8, 13}));
}

TEST(PlacesWorker, AnAdjustmentBringsBackWhatWasMovedAndTellsAllKeyframes) {
  const EdgeScene scene = framesOnAWall(25);
  const std::vector<Pose> way = row(5, 0.1);
  PlacesWorker places(distorted_camera, settingsOf(dueEvery(1, 1e6)));
  EXPECT_TRUE(places.work(snapshotOf(grown(scene, way, 4))).change.empty()) << "the first one: just mapped";
  Map moved = grown(scene, way, 5);
  moved.keyframes[1].world_T_camera.translation.y() += 0.01;
  const Snapshot snapshot = snapshotOf(moved);
  const Correction correction = places.work(snapshot);
  ASSERT_FALSE(correction.change.empty());
  EXPECT_EQ(snapshot.map->keyframes[1].world_T_camera.translation, moved.keyframes[1].world_T_camera.translation)
      << "the snapshot stays as it is";
  Map corrected = *snapshot.map;
  applyChange(correction.change, corrected);
  ASSERT_EQ(correction.change.world_T_camera.size(), way.size());
  for (const Keyframe& keyframe : corrected.keyframes) {
    EXPECT_LT(distance(keyframe.world_T_camera, way[static_cast<std::size_t>(keyframe.id)]), 0.002) << keyframe.id;
  }
}

TEST(PlacesWorker, SnapshotsPassedOverDoNotPutOffAnAdjustment) {
  const EdgeScene scene = framesOnAWall(25);
  const std::vector<Pose> way = row(17, 0.05);
  PlacesWorker places(distorted_camera, settingsOf(dueEvery(5, 1e6)));
  EXPECT_TRUE(places.work(snapshotOf(grown(scene, way, 4))).change.empty());
  EXPECT_FALSE(places.work(snapshotOf(grown(scene, way, 12))).change.empty()) << "8 keyframes later";
  EXPECT_TRUE(places.work(snapshotOf(grown(scene, way, 16))).change.empty()) << "4 after the last time";
  EXPECT_FALSE(places.work(snapshotOf(grown(scene, way, 17))).change.empty());
}

TEST(PlacesWorker, AMapBegunAnewIsCountedAnew) {
  const EdgeScene scene = framesOnAWall(25);
  const std::vector<Pose> way = row(10, 0.05);
  PlacesWorker places(distorted_camera, settingsOf(dueEvery(5, 1e6)));
  corrections(places, scene, way, 3, 6);
  for (std::size_t count = 4; count <= 9; ++count) {
    const Correction correction = places.work(snapshotOf(grown(scene, way, count, 0, /*first_frame=*/500)));
    EXPECT_EQ(correction.change.empty(), count < 9) << count;
  }
}

TEST(PlacesWorker, AnOldPartIsMetOnceAMeetingAndAgainLater) {
  const EdgeScene scene = longWall(80, 1600);
  std::vector<Pose> way;
  const auto walk = [&](double from, int steps) {
    for (int step = 0; step < steps; ++step) way.push_back(at(from + 1.5 * step));
  };
  walk(0, 15);
  walk(1, 3);  // keyframes 15 to 17, at the start
  walk(40, 12);
  walk(41, 3);  // keyframes 30 to 32, where 18 was
  PlacesWorker places(distorted_camera, settingsOf(neverDue(/*old_keyframes=*/8)));
  const auto done = corrections(places, scene, way, 2, 32);
  EXPECT_EQ(changedAt(done, 2), (std::vector<KeyframeId>{15, 30}));
  for (std::size_t i = 0; i < done.size(); ++i) {
    const auto id = static_cast<KeyframeId>(i) + 2;
    const bool met = id == 15 || id == 30;
    ASSERT_EQ(done[i].loop.has_value(), met) << id;
    EXPECT_EQ(done[i].events.size(), met ? 1U : 0U) << id;
    if (!met) continue;
    EXPECT_EQ(done[i].loop->how, "by its points");
    EXPECT_EQ(done[i].loop->keyframe, id);
    EXPECT_EQ(done[i].loop->frame_index, 10 * id);
    EXPECT_EQ(done[i].loop->before.size(), i + 3);
    EXPECT_EQ(done[i].loop->after.size(), i + 3);
    EXPECT_NE(done[i].events.front().find("met again"), std::string::npos);
  }
}

TEST(PlacesWorker, ALongMeetingSharesOutItsDriftFromTimeToTimeButIsToldOnce) {
  const EdgeScene scene = longWall(80, 1600);
  std::vector<Pose> way;
  for (int k = 0; k < 15; ++k) way.push_back(at(1.5 * k));
  for (int k = 0; k < 8; ++k) way.push_back(at(1 + 0.8 * k));  // keyframes 15 to 22, along the start
  PlacesWorker places(distorted_camera, settingsOf(neverDue(/*old_keyframes=*/8)));
  const auto done = corrections(places, scene, way, 12, 22);
  EXPECT_EQ(changedAt(done, 12), (std::vector<KeyframeId>{15, 18, 21})) << "every 8 / 4 + 1 keyframes";
  for (std::size_t i = 0; i < done.size(); ++i) {
    EXPECT_EQ(done[i].loop.has_value(), i + 12 == 15) << i + 12;
    EXPECT_EQ(done[i].events.empty(), i + 12 != 15) << i + 12;
  }
}

TEST(PlacesWorker, AMeetingIsAnAdjustmentOfTheWholeMapToo) {
  const EdgeScene scene = longWall(80, 1600);
  std::vector<Pose> way;
  for (int k = 0; k < 15; ++k) way.push_back(at(1.5 * k));
  way.push_back(at(1));
  for (int k = 0; k < 9; ++k) way.push_back(at(40 + 1.5 * k));
  PlacesOptions options = neverDue(/*old_keyframes=*/8);
  options.global_interval_keyframes = 7;
  PlacesWorker places(distorted_camera, settingsOf(options));
  // 11 after 4, met at 15, due at 22.
  const auto done = corrections(places, scene, way, 4, 24);
  EXPECT_EQ(changedAt(done, 4), (std::vector<KeyframeId>{11, 15, 22}));
}

TEST(PlacesWorker, WithoutLoopsAnOldPartIsNotLookedFor) {
  const EdgeScene scene = longWall(80, 1600);
  std::vector<Pose> way = row(15, 1.5);
  way.push_back(at(1));
  way.push_back(at(2.5));
  Settings settings = settingsOf(neverDue(/*old_keyframes=*/8));
  settings.loops.enabled = false;
  PlacesWorker places(distorted_camera, settings);
  for (const Correction& correction : corrections(places, scene, way, 12, 16)) {
    EXPECT_TRUE(correction.change.empty());
    EXPECT_TRUE(correction.events.empty());
    EXPECT_FALSE(correction.loop);
  }
}

TEST(PlacesWorker, ASavedMapGoneOnWithIsNoLoop) {
  const EdgeScene scene = longWall(80, 1600);
  std::vector<Pose> way = row(15, 1.5);
  for (int k = 0; k < 4; ++k) way.push_back(at(1 + 0.8 * k));  // of the new run, found again at the start
  PlacesWorker places(distorted_camera, settingsOf(neverDue(/*old_keyframes=*/8)));
  for (const Correction& correction : corrections(places, scene, way, 15, 18)) {
    EXPECT_FALSE(correction.loop) << "it was never away";
    EXPECT_TRUE(correction.events.empty());
  }
}

}  // namespace
}  // namespace edgeslam::test
