// Final poses: where a map changed after a frame was located, its pose is found once more; what its points do not tell
// stays.
#include "pipeline/final_poses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/mapping/landmark_walk.h"

namespace edgeslam {
namespace {

constexpr int walked_keyframes = 10;

test::Walk walkedMap() {
  test::Walk walk(1, 900);
  for (int k = 0; k < walked_keyframes; ++k) walk.step();
  return walk;
}

// Beside the sixth keyframe, which sees points that several see.
Pose besideKeyframe(const test::Walk& walk) {
  Vector6d step;
  step << 0.05, -0.03, 0.04, 0.01, -0.02, 0.01;
  return retract(walk.poses[5], step);
}

// What a camera there sees of the landmarks, across edges of the direction `normal`.
SeenPoints seenFrom(const test::Walk& walk, const Camera& camera, const MovingCamera& moving,
                    const Eigen::Vector2f& normal, float sigma_tangent) {
  std::vector<Track> tracks;
  for (std::size_t i = 0; i < walk.landmarks.size(); ++i) {
    const Eigen::Vector3d in_camera = moving.world_T_camera.inverse() * walk.landmarks[i];
    if (!inFront(camera, in_camera)) continue;
    const Eigen::Vector2d pixel = projectToRow(camera, moving.twist, in_camera);
    if (!insideImage(camera, pixel, 5)) continue;
    Track track;
    track.id = static_cast<PointId>(i);
    track.pixel = pixel.cast<float>();
    track.normal = normal;
    track.sigma_normal = 0.2F;
    track.sigma_tangent = sigma_tangent;
    tracks.push_back(track);
  }
  SeenPoints seen;
  pack(camera, tracks, tracks.size(), seen);
  return seen;
}

Pose movedBy(const Pose& pose, double x, double y, double z) {
  Vector6d step = Vector6d::Zero();
  step.head<3>() << x, y, z;
  return retract(pose, step);
}

double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }

TEST(FinalPoses, AFrameThatWasCarriedToAWrongPlaceIsFoundWhereItWas) {
  const test::Walk walk = walkedMap();
  const Pose truth = besideKeyframe(walk);
  const SeenPoints seen = seenFrom(walk, test::Walk::camera(), truth, {1, 0}, 0.2F);
  ASSERT_GT(seen.points.size(), 100U);
  const std::optional<Pose> pose =
      locateAnew(test::Walk::camera(), walk.map, 0, seen, movedBy(truth, 0.04, -0.03, 0.03), {});
  ASSERT_TRUE(pose);
  EXPECT_LT(distance(*pose, truth), 0.002);
}

TEST(FinalPoses, WhatTheEdgesDoNotTellStaysAsItWasCarried) {
  const test::Walk walk = walkedMap();
  const Pose truth = besideKeyframe(walk);
  const SeenPoints seen = seenFrom(walk, test::Walk::camera(), truth, {0, 1}, 1000);  // level edges
  const Pose carried = movedBy(truth, 0.03, 0.03, 0);
  const std::optional<Pose> pose = locateAnew(test::Walk::camera(), walk.map, 0, seen, carried, {});
  ASSERT_TRUE(pose);
  const Eigen::Vector3d left = (truth.inverse() * *pose).translation;
  EXPECT_NEAR(left.x(), 0.03, 0.003) << "along the edges";
  EXPECT_NEAR(left.y(), 0, 0.003) << "across them";
}

TEST(FinalPoses, WithTooFewPointsOrInAnotherWorldThereIsNone) {
  const test::Walk walk = walkedMap();
  const Pose truth = besideKeyframe(walk);
  const SeenPoints seen = seenFrom(walk, test::Walk::camera(), truth, {1, 0}, 0.2F);
  EXPECT_FALSE(locateAnew(test::Walk::camera(), walk.map, 1, seen, truth, {}));
  Map few = walk.map;
  while (few.points.size() > 20) few.points.erase(few.points.begin());
  EXPECT_FALSE(locateAnew(test::Walk::camera(), few, 0, seen, truth, {}));
  EXPECT_FALSE(locateAnew(test::Walk::camera(), walk.map, 0, {}, truth, {}));
}

// Frames of a steady motion by a camera whose rows are read over 30 ms, as they come out where that is not known.
std::deque<FrameRecord> rollingFrames(const test::Walk& walk, const Camera& camera, std::vector<Pose>& truth,
                                      SeenRecord& seen) {
  Twist twist;
  twist << 0.5, -0.2, 0.3, 0.2, 0.3, -0.4;
  std::deque<FrameRecord> frames;
  for (int i = 0; i < 6; ++i) {
    const Pose pose = besideKeyframe(walk) * movedFor(twist, 0.033 * i);
    truth.push_back(pose);
    FrameRecord& frame = frames.emplace_back();
    frame.time_ns = std::int64_t{33'000'000} * i;
    frame.has_final_pose = true;
    frame.final_world = 0;
    seen.add(seenFrom(walk, camera, {pose, twist}, {1, 0}, 0.2F));
    Camera still = camera;
    still.readout_s = 0;
    frame.final_world_T_camera = locateAnew(still, walk.map, 0, seen.of(frames.size() - 1), pose, {}).value_or(pose);
  }
  return frames;
}

TEST(FinalPoses, TheMotionOfARollingShutterIsThatOfTheNeighbouringFrames) {
  const test::Walk walk = walkedMap();
  Camera camera = test::Walk::camera();
  camera.readout_s = 0.03;
  std::vector<Pose> truth;
  SeenRecord seen;
  std::deque<FrameRecord> frames = rollingFrames(walk, camera, truth, seen);
  const std::deque<FrameRecord> before = frames;
  frames[2].is_keyframe = true;
  locateFramesAnew(camera, walk.map, {}, seen, frames);
  double error_before = 0, error = 0;
  for (const std::size_t i : {1U, 3U, 4U}) {
    error_before += distance(before[i].final_world_T_camera, truth[i]);
    error += distance(frames[i].final_world_T_camera, truth[i]);
  }
  EXPECT_LT(error, 0.3 * error_before);
  EXPECT_EQ(frames[2].final_world_T_camera.translation, before[2].final_world_T_camera.translation)
      << "a keyframe has its pose by the adjustment";
}

// Of a camera that goes to and fro before level edges only, so that it may have slid along them; every eighth is a
// keyframe.
void slideAlongEdges(const test::Walk& walk, int count, std::vector<Pose>& truth, SeenRecord& seen,
                     std::deque<FrameRecord>& frames) {
  const Camera camera = test::Walk::camera();
  Twist way;
  way << 0.2, -0.05, 0.1, 0.02, 0.05, -0.04;
  for (int i = 0; i < count; ++i) {
    truth.push_back(besideKeyframe(walk) * movedFor(way, std::sin(0.033 * i)));
    FrameRecord& frame = frames.emplace_back();
    frame.time_ns = std::int64_t{33'000'000} * i;
    frame.has_final_pose = true;
    frame.final_world = 0;
    frame.is_keyframe = i % 8 == 0;
    seen.add(seenFrom(walk, camera, truth.back(), {0, 1}, 1000));
    const Pose slid = movedBy(truth.back(), i % 2 == 0 ? 0.03 : -0.05, 0, 0);
    frame.final_world_T_camera = frame.is_keyframe ? truth.back() : slid;
  }
}

TEST(FinalPoses, FramesBetweenKeyframesFollowTheMotionWhereEdgesTellNothing) {
  const test::Walk walk = walkedMap();
  const Camera camera = test::Walk::camera();
  std::vector<Pose> truth;
  SeenRecord seen;
  std::deque<FrameRecord> frames;
  slideAlongEdges(walk, 57, truth, seen, frames);
  const auto meanError = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) sum += distance(frames[i].final_world_T_camera, truth[i]);
    return sum / static_cast<double>(frames.size());
  };
  const double before = meanError();
  std::deque<FrameRecord> few(frames.begin(), frames.begin() + 20);
  smoothFrames(camera, walk.map, {}, seen, frames);
  EXPECT_LT(meanError(), 0.15 * before);
  EXPECT_EQ(frames[8].final_world_T_camera.translation, truth[8].translation);

  const std::deque<FrameRecord> untouched = few;
  smoothFrames(camera, walk.map, {}, seen, few);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].final_world_T_camera.translation, untouched[i].final_world_T_camera.translation)
        << "three keyframes do not tell how the camera moves";
  }
}

TEST(FinalPoses, ALongRunIsSmoothedInPieces) {
  const test::Walk walk = walkedMap();
  std::vector<Pose> truth;
  SeenRecord seen;
  std::deque<FrameRecord> frames;
  slideAlongEdges(walk, 1100, truth, seen, frames);
  smoothFrames(test::Walk::camera(), walk.map, {}, seen, frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_LT(distance(frames[i].final_world_T_camera, truth[i]), 0.015) << i;
  }
}

TEST(FinalPoses, FramesThatShowNothingOfTheMapStayWhereTheWheelsTookThem) {
  const test::Walk walk = walkedMap();
  std::vector<Pose> truth;
  SeenRecord seen, with_gap;
  std::deque<FrameRecord> frames;
  slideAlongEdges(walk, 97, truth, seen, frames);
  const auto isBlind = [](std::size_t i) { return i > 40 && i < 48; };
  for (std::size_t i = 0; i < frames.size(); ++i) with_gap.add(isBlind(i) ? SeenPoints() : seen.of(i));
  const std::deque<FrameRecord> before = frames;
  smoothFrames(test::Walk::camera(), walk.map, {}, with_gap, frames);
  for (std::size_t i = 41; i < 48; ++i) {
    EXPECT_EQ(frames[i].final_world_T_camera.translation, before[i].final_world_T_camera.translation) << i;
  }
  EXPECT_LT(distance(frames[20].final_world_T_camera, truth[20]), 0.015);
  EXPECT_LT(distance(frames[70].final_world_T_camera, truth[70]), 0.015);
}

}  // namespace
}  // namespace edgeslam
