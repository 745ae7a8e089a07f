// P22 in a rendered room of known truth: the camera is found where the map saw, and nowhere else.
#include "places/relocalisation.h"

#include <gtest/gtest.h>

#include "unit/geometry/degree.h"
#include "unit/map/change_each.h"
#include "unit/places/made_place.h"

namespace edgeslam::test {
namespace {

constexpr std::uint64_t room_seed = 7;

struct SeenFrame {
  FrameImages images;
  EdgeMap edges;
};

SeenFrame frameOf(const cv::Mat& grey) {
  SeenFrame frame;
  frame.images.pyramid = buildPyramid(grey, 4);
  frame.edges = detectEdges(grey, {});
  return frame;
}

Relocalisation knowing(const Map& map, const RelocalisationOptions& options = {}) {
  Relocalisation relocalisation(placeCamera(), {}, options);
  for (const Keyframe& keyframe : map.keyframes) relocalisation.addKeyframe(keyframe);
  return relocalisation;
}

// A quarter of the room, made once.
const Map& place() {
  static const Map map = [] {
    std::vector<Pose> poses = turnAround(36, 0);
    poses.resize(10);
    return makePlace(room_seed, placeCamera(), poses);
  }();
  return map;
}

Pose near(KeyframeId keyframe, const Eigen::Vector3d& moved, const Eigen::Vector3d& turned_deg) {
  Vector6d update;
  update << moved, turned_deg * degree;
  return retract(place().keyframes[keyframe].world_T_camera, update);
}

RelocalisationResult relocaliseAt(const Pose& pose, const std::optional<Reachable>& reachable = std::nullopt) {
  static const Relocalisation relocalisation = knowing(place());
  const SeenFrame frame = frameOf(renderRoom(room_seed, placeCamera(), pose));
  return relocalisation.relocalise(place(), frame.images, frame.edges, reachable);
}

double distanceApart(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }
double rotationErrorDeg(const Pose& a, const Pose& b) { return rotationAngle(a.rotation, b.rotation) / degree; }

struct View {
  const char* name;
  KeyframeId keyframe;
  Eigen::Vector3d moved;
  Eigen::Vector3d turned_deg;
};

class RelocalisationFrom : public testing::TestWithParam<View> {};

TEST_P(RelocalisationFrom, TheCameraIsFound) {
  const Pose truth = near(GetParam().keyframe, GetParam().moved, GetParam().turned_deg);
  const RelocalisationResult result = relocaliseAt(truth);
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_LT(distanceApart(result.world_T_camera, truth), 0.02);
  EXPECT_LT(rotationErrorDeg(result.world_T_camera, truth), 0.4);
  EXPECT_GE(result.evidence.inliers, 30);
  EXPECT_EQ(static_cast<int>(result.matches.size()), result.evidence.inliers);
  EXPECT_GT(result.pose.covariance.diagonal().minCoeff(), 0);
  // The matches are the map's points, each where it is seen.
  for (const MatchedPoint& match : result.matches) {
    const auto point = place().points.find(match.point);
    ASSERT_NE(point, place().points.end());
    const Eigen::Vector3d seen = truth.inverse() * worldPosition(place(), point->second);
    const Eigen::Vector2d apart = match.measurement.pixel - project(placeCamera(), seen);
    EXPECT_LT(std::abs(apart.dot(match.measurement.normal)), 3);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Views, RelocalisationFrom,
    testing::Values(View{"TheKeyframeItself", 4, {0, 0, 0}, {0, 0, 0}}, View{"Beside", 4, {0.15, 0.05, 0}, {0, 0, 0}},
                    View{"Nearer", 5, {0, 0, 0.25}, {0, 0, 0}}, View{"Turned", 4, {0, 0, 0}, {3, 4, 0}},
                    View{"Rolled", 3, {0, 0, 0}, {0, 0, 15}}, View{"AllAtOnce", 6, {-0.1, 0.08, 0.1}, {-3, 5, -8}}),
    [](const auto& view) { return std::string(view.param.name); });

TEST(Relocalisation, AnotherRoomIsNotTakenForThisOne) {
  const Relocalisation relocalisation = knowing(place());
  for (const std::uint64_t other : {8U, 9U}) {
    for (const KeyframeId keyframe : {1, 4, 7}) {
      const Pose& pose = place().keyframes[keyframe].world_T_camera;
      const SeenFrame frame = frameOf(renderRoom(other, placeCamera(), pose));
      const RelocalisationResult result = relocalisation.relocalise(place(), frame.images, frame.edges);
      EXPECT_FALSE(result.found);
      EXPECT_TRUE(result.matches.empty());
      EXPECT_FALSE(result.reason.empty());
    }
  }
}

TEST(Relocalisation, AnUnmappedPartOfTheRoomIsNotFound) {
  Pose pose = near(0, {0, 0, 0}, {0, 180, 0});
  EXPECT_FALSE(relocaliseAt(pose).found);
}

TEST(Relocalisation, CoveredLensIsNotFound) {
  const Relocalisation relocalisation = knowing(place());
  for (const int grey : {0, 30, 255}) {
    const SeenFrame frame = frameOf(cv::Mat(240, 320, CV_8U, cv::Scalar(grey)));
    const RelocalisationResult result = relocalisation.relocalise(place(), frame.images, frame.edges);
    EXPECT_FALSE(result.found);
    EXPECT_FALSE(result.reason.empty());
  }
}

TEST(Relocalisation, HiddenPartsMayRefuseItButNotMislead) {
  const Relocalisation relocalisation = knowing(place());
  const Pose truth = near(4, {0.05, 0, 0.05}, {0, 1, 0});
  int found = 0;
  for (const double hidden : {0.2, 0.4, 0.6, 0.8}) {
    cv::Mat grey = renderRoom(room_seed, placeCamera(), truth);
    grey.colRange(0, static_cast<int>(hidden * grey.cols)).setTo(90);
    const SeenFrame frame = frameOf(grey);
    const RelocalisationResult result = relocalisation.relocalise(place(), frame.images, frame.edges);
    if (!result.found) continue;
    ++found;
    EXPECT_LT(distanceApart(result.world_T_camera, truth), 0.03) << hidden;
  }
  EXPECT_GE(found, 1);
}

TEST(Relocalisation, PosesAreInTheWorldFrameAsTheMapHasItNow) {
  Map moved = place();
  const Pose correction{rotationExp({0.3, -0.5, 1}), {4, 5, -6}};
  const Relocalisation relocalisation = knowing(place());
  for (Keyframe& keyframe : moved.keyframes) keyframe.world_T_camera = correction * keyframe.world_T_camera;
  const Pose truth = near(4, {0.1, 0, 0}, {0, 2, 0});
  const SeenFrame frame = frameOf(renderRoom(room_seed, placeCamera(), truth));
  const RelocalisationResult result = relocalisation.relocalise(moved, frame.images, frame.edges);
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_LT(distanceApart(result.world_T_camera, correction * truth), 0.02);
  EXPECT_LT(rotationErrorDeg(result.world_T_camera, correction * truth), 0.4);
}

TEST(Relocalisation, SameInputSameResult) {
  const Pose truth = near(5, {0.1, 0, 0.1}, {0, 4, 6});
  const RelocalisationResult once = relocaliseAt(truth), again = relocaliseAt(truth);
  EXPECT_EQ(once.world_T_camera.translation, again.world_T_camera.translation);
  EXPECT_EQ(once.world_T_camera.rotation.coeffs(), again.world_T_camera.rotation.coeffs());
  EXPECT_EQ(once.matches.size(), again.matches.size());
}

TEST(Relocalisation, OutOfReachIsRefused) {
  const Pose truth = near(4, {0.1, 0, 0}, {0, 0, 0});
  EXPECT_TRUE(relocaliseAt(truth, Reachable{truth.translation, 0.5}).found);
  EXPECT_FALSE(relocaliseAt(truth, Reachable{truth.translation + Eigen::Vector3d(3, 0, 0), 0.5}).found);
}

// The place and, ten metres on, the same again.
Map twice(const Map& map) {
  Map both = map;
  const auto count = static_cast<KeyframeId>(map.keyframes.size());
  constexpr PointId offset = 1000000;
  for (Keyframe keyframe : map.keyframes) {
    keyframe.id += count;
    keyframe.world_T_camera.translation += Eigen::Vector3d(10, 0, 0);
    test::changeEach(keyframe.observations, [&](PointObservation& observation) { observation.point += offset; });
    both.keyframes.push_back(std::move(keyframe));
  }
  for (auto [id, point] : map.points) {
    point.id += offset;
    point.host += count;
    for (KeyframeId& seen : point.seen_in) seen += count;
    both.points.emplace(point.id, point);
  }
  return both;
}

TEST(Relocalisation, WhatRepeatsIsNotGuessed) {
  const Map both = twice(place());
  const Relocalisation relocalisation = knowing(both);
  const Pose truth = near(4, {0.05, 0, 0}, {0, 1, 0});
  const SeenFrame frame = frameOf(renderRoom(room_seed, placeCamera(), truth));
  const RelocalisationResult result = relocalisation.relocalise(both, frame.images, frame.edges);
  EXPECT_FALSE(result.found);
  EXPECT_NE(result.reason.find("two different poses"), std::string::npos) << result.reason;
  // What can be reached decides.
  const RelocalisationResult bounded =
      relocalisation.relocalise(both, frame.images, frame.edges, Reachable{truth.translation, 2});
  ASSERT_TRUE(bounded.found) << bounded.reason;
  EXPECT_LT(distanceApart(bounded.world_T_camera, truth), 0.02);
}

TEST(Relocalisation, ForgottenKeyframesAreNotFound) {
  Relocalisation relocalisation = knowing(place());
  const SeenFrame frame = frameOf(renderRoom(room_seed, placeCamera(), near(4, {0, 0, 0}, {0, 0, 0})));
  relocalisation.update(Map());
  const RelocalisationResult result = relocalisation.relocalise(place(), frame.images, frame.edges);
  EXPECT_FALSE(result.found);
  EXPECT_EQ(result.reason, "no keyframe looks like this frame");
  EXPECT_FALSE(relocalisation.relocalise(Map(), frame.images, frame.edges).found);
}

TEST(Relocalisation, LaterKeyframesAreLeftOutWhereTheyAreInDoubt) {
  const Relocalisation relocalisation = knowing(place());
  const Pose truth = near(4, {0.02, 0, 0}, {0, 0, 0});
  const SeenFrame frame = frameOf(renderRoom(room_seed, placeCamera(), truth));
  const RelocalisationResult all = relocalisation.relocalise(place(), frame.images, frame.edges);
  ASSERT_TRUE(all.found) << all.reason;
  const RelocalisationResult before =
      relocalisation.relocalise(place(), frame.images, frame.edges, std::nullopt, 1, all.keyframe - 1);
  ASSERT_TRUE(before.found) << before.reason;  // by a neighbour
  EXPECT_LT(before.keyframe, all.keyframe);
  EXPECT_LT(distanceApart(before.world_T_camera, truth), 0.02);
  const RelocalisationResult none = relocalisation.relocalise(place(), frame.images, frame.edges, std::nullopt, 1, -1);
  EXPECT_FALSE(none.found);
  EXPECT_EQ(none.reason, "no keyframe looks like this frame");
}

TEST(Relocalisation, KeyframesWithoutImagesArePassedOver) {
  Map map = place();
  map.keyframes[4].images = nullptr;
  const Relocalisation relocalisation = knowing(map);
  const Pose truth = near(4, {0.05, 0, 0}, {0, 0, 0});
  const SeenFrame frame = frameOf(renderRoom(room_seed, placeCamera(), truth));
  const RelocalisationResult result = relocalisation.relocalise(map, frame.images, frame.edges);
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_NE(result.keyframe, 4);
  EXPECT_LT(distanceApart(result.world_T_camera, truth), 0.02);
}

}  // namespace
}  // namespace edgeslam::test
