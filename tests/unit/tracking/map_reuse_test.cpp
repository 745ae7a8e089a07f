// Map points that came into view again are found and followed on.
#include "tracking/map_reuse.h"

#include <gtest/gtest.h>

#include "edges/point_choice.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// A view of a map whose points a keyframe at the origin chose on a textured plane; the camera has moved on.
struct Revisit {
  Camera camera = smallCamera();
  MapView view;
  std::shared_ptr<const FrameImages> images;
  EdgeMap edges;
  Pose world_T_camera;
};

Revisit revisit() {
  Revisit made;
  const TexturedPlane plane{SmoothTexture(51, 10, 60)};
  const auto keyframe = imagesOf(plane.render(made.camera, Pose()));
  made.view.initialised = true;
  made.view.keyframes = {{0, Pose(), keyframe}};
  const cv::Mat& grey = keyframe->pyramid.levels[0];
  PointId id = 0;
  for (const ChosenPoint& chosen : choosePoints(grey, detectEdges(grey, EdgeOptions()), {}, PointChoiceOptions())) {
    ViewPoint point = viewPoint(made.view, id++, 0, plane.seenAt(made.camera, Pose(), chosen.pixel.cast<double>()));
    point.source = 0;
    point.source_measurement = {chosen.pixel.cast<double>(), chosen.normal.cast<double>(), chosen.sigma_normal,
                                chosen.sigma_tangent};
    point.corner = chosen.corner;
    made.view.points.push_back(point);
  }
  Vector6d motion;
  motion << 0.05, -0.03, 0.02, 0.01, 0.02, -0.01;
  made.world_T_camera = retract(Pose(), motion);
  made.images = imagesOf(plane.render(made.camera, made.world_T_camera), 1);
  made.edges = detectEdges(made.images->pyramid.levels[0], EdgeOptions());
  return made;
}

double errorOf(const Revisit& made, const Track& track) {
  const Eigen::Vector3d position = worldPosition(made.view, *findPoint(made.view, track.id));
  const Eigen::Vector2d projected = project(made.camera, made.world_T_camera.inverse() * position);
  return std::abs(track.normal.cast<double>().dot(projected - track.pixel.cast<double>()));
}

TEST(MapReuse, FindsWhatCameIntoViewAgainWhereItIs) {
  const Revisit made = revisit();
  ASSERT_GT(made.view.points.size(), 100u);
  std::vector<Track> tracks;
  reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, 1000, {}, tracks);
  EXPECT_GT(tracks.size(), made.view.points.size() / 2);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    EXPECT_LT(errorOf(made, tracks[i]), 0.5);
    if (i > 0) {
      EXPECT_LT(tracks[i - 1].id, tracks[i].id);
    }
  }
}

TEST(MapReuse, WhatIsFollowedIsNotTakenTwiceAndTheNumberIsKept) {
  const Revisit made = revisit();
  std::vector<Track> tracks;
  reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, 40, {}, tracks);
  ASSERT_EQ(tracks.size(), 40u);
  reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, 60, {}, tracks);
  ASSERT_EQ(tracks.size(), 60u);
  for (std::size_t i = 1; i < tracks.size(); ++i) EXPECT_LT(tracks[i - 1].id, tracks[i].id);
}

TEST(MapReuse, NothingIsFoundInAnotherPlace) {
  Revisit made = revisit();
  made.images = imagesOf(cv::Mat(made.camera.height, made.camera.width, CV_8U, cv::Scalar(100)), 1);
  made.edges = detectEdges(made.images->pyramid.levels[0], EdgeOptions());
  std::vector<Track> tracks;
  reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, 1000, {}, tracks);
  EXPECT_TRUE(tracks.empty());
}

TEST(MapReuse, TellsHowManyPointsOfSomeAgeAreWhereTheyShouldBe) {
  Revisit made = revisit();
  std::vector<Track> tracks;
  const auto reuse = [&] {
    return reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, 1000, {}, tracks);
  };
  EXPECT_EQ(reuse()->expected, 0);  // all are of the latest keyframe
  tracks.clear();
  made.view.keyframes.push_back({MapReuseOptions().confirming_age, made.world_T_camera, nullptr});
  const PointsConfirmed found = *reuse();
  EXPECT_GT(found.expected, static_cast<int>(made.view.points.size() / 2));
  EXPECT_GE(found.confirmed, static_cast<int>(tracks.size()));
  EXPECT_LE(found.confirmed, found.expected);

  // Those followed now count too, but not where they contradict the pose.
  for (Track& track : tracks) track.outlier_frames = 1;
  const PointsConfirmed followed = *reuse();
  EXPECT_EQ(followed.expected, found.expected);
  EXPECT_LT(followed.confirmed, found.confirmed / 2);

  tracks.resize(tracks.size() / 2);
  EXPECT_FALSE(
      reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, tracks.size(), {}, tracks));
}

TEST(MapReuse, CanBeSwitchedOff) {
  const Revisit made = revisit();
  MapReuseOptions off;
  off.enabled = false;
  std::vector<Track> tracks;
  reuseMapPoints(made.camera, made.view, *made.images, made.edges, made.world_T_camera, 1000, off, tracks);
  EXPECT_TRUE(tracks.empty());
}

}  // namespace
}  // namespace edgeslam
