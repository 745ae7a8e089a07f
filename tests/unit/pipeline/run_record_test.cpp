// What a run leaves of its frames where the map is of several worlds: final poses in the worlds as they are in the end.
#include "pipeline/run_record.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace edgeslam {
namespace {

// Keyframe `id` at x = id, in this world.
void addKeyframe(KeyframeId id, int world, Map& map) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.frame_index = 10 * id;
  keyframe.world = world;
  keyframe.world_T_camera.translation.x() = id;
  map.keyframes.push_back(keyframe);
}

// Keyframes 0 and 1 in world 0, and 2 and 3 in `world`.
Mapper mapperWith(int world) {
  Map map;
  for (const KeyframeId id : {0, 1}) addKeyframe(id, 0, map);
  for (const KeyframeId id : {2, 3}) addKeyframe(id, world, map);
  Mapper mapper{Camera(), MapperOptions()};
  mapper.goOnWith(map);
  return mapper;
}

// A frame that was tracked in this world, 1 above its keyframe.
FrameResult trackedIn(int world, std::int64_t index, KeyframeId reference) {
  FrameResult frame;
  frame.index = index;
  frame.state = TrackingState::tracking;
  frame.has_pose = true;
  frame.world = world;
  frame.reference = reference;
  frame.reference_T_camera.translation.y() = 1;
  return frame;
}

MappingReport joinOf(int from, int to, double scale) {
  MappingReport report;
  report.join = WorldJoin{from, to, {scale, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()}};
  return report;
}

TEST(RunRecord, EachFrameHasItsPoseInItsWorld) {
  RunRecord record{Camera()};
  record.add(trackedIn(0, 5, 1), false);
  for (const std::int64_t index : {20, 21, 22}) record.add(trackedIn(1, index, 2), false);
  const RunResult result = record.finish(mapperWith(1));
  EXPECT_EQ(result.frames[0].final_world, 0);
  EXPECT_EQ(result.frames[1].final_world, 1);
  EXPECT_EQ(result.frames[1].final_world_T_camera.translation, Eigen::Vector3d(2, 1, 0));
  EXPECT_EQ(result.main_world, 1) << "it has most poses";
  ASSERT_EQ(result.keyframes.size(), 4U);
  EXPECT_EQ(result.keyframes[3].world, 1);
}

TEST(RunRecord, WhatWasTrackedInAWorldThatWasJoinedIsInTheOthersUnit) {
  RunRecord record{Camera()};
  record.add(trackedIn(1, 20, 2), false);
  record.add(joinOf(1, 0, 2.5));
  record.add(trackedIn(1, 21, 2), false);  // tracking had not heard of it yet
  record.add(trackedIn(0, 22, 2), false);
  const RunResult result = record.finish(mapperWith(0));
  for (const FrameRecord& frame : result.frames) EXPECT_EQ(frame.final_world, 0) << frame.index;
  EXPECT_EQ(result.frames[0].final_world_T_camera.translation, Eigen::Vector3d(2, 2.5, 0));
  EXPECT_EQ(result.frames[1].final_world_T_camera.translation, Eigen::Vector3d(2, 2.5, 0));
  EXPECT_EQ(result.frames[2].final_world_T_camera.translation, Eigen::Vector3d(2, 1, 0));
}

TEST(RunRecord, TwoJoinsOneAfterTheOther) {
  RunRecord record{Camera()};
  record.add(trackedIn(2, 20, 2), false);
  record.add(joinOf(2, 1, 2));
  record.add(joinOf(1, 0, 3));
  record.add(trackedIn(2, 21, 2), false);
  const RunResult result = record.finish(mapperWith(0));
  EXPECT_EQ(result.frames[0].final_world_T_camera.translation.y(), 6);
  EXPECT_EQ(result.frames[1].final_world_T_camera.translation.y(), 6);
}

TEST(RunRecord, AWorldThatHadToGoLeavesItsPoses) {
  RunRecord record{Camera()};
  record.add(trackedIn(4, 20, 8), false);
  MappingReport report;
  Pose world_T_culled;
  world_T_culled.translation = {7, 0, 0};
  report.culled = {{8, -1, world_T_culled, 4}};
  record.add(report);
  const RunResult result = record.finish(mapperWith(0));
  ASSERT_TRUE(result.frames[0].has_final_pose);
  EXPECT_EQ(result.frames[0].final_world, 4);
  EXPECT_EQ(result.frames[0].final_world_T_camera.translation, Eigen::Vector3d(7, 1, 0));
}

TEST(RunRecord, WhatFramesSawTakesNoMemory) {
  FrameResult frame = trackedIn(0, 0, 1);
  frame.seen.points.resize(1000);
  RunRecord record{Camera()};
  EXPECT_EQ(record.add(frame, false).seen.points.capacity(), 0U);
  EXPECT_TRUE(record.events().empty());
}

TEST(RunRecord, ThatWhatFramesSeeCannotBeKeptIsToldOnce) {
  const char* before = std::getenv("TMPDIR");
  const std::string temporary = before ? before : "/tmp";
  setenv("TMPDIR", "/dev/null/nowhere", 1);
  RunRecord record{Camera()};
  setenv("TMPDIR", temporary.c_str(), 1);
  FrameResult frame = trackedIn(0, 0, 1);
  record.add(frame, false);
  EXPECT_TRUE(record.events().empty()) << "it saw nothing that is to be kept";
  frame.seen.points.resize(10);
  for (frame.index = 1; frame.index < 4; ++frame.index) record.add(frame, false);
  ASSERT_EQ(record.events().size(), 1U);
  EXPECT_EQ(record.events()[0].rfind("frame 1: no room for what frames see (", 0), 0U) << record.events()[0];
  const RunResult result = record.finish(mapperWith(0));
  for (const FrameRecord& of_run : result.frames) EXPECT_TRUE(of_run.has_final_pose);
}

TEST(RunRecord, WithoutAMapThereAreNoFinalPoses) {
  RunRecord record{Camera()};
  record.add(trackedIn(0, 5, 1), false);
  const RunResult result = record.finish(Mapper(Camera(), MapperOptions()));
  EXPECT_FALSE(result.frames[0].has_final_pose);
}

}  // namespace
}  // namespace edgeslam
