// P26: a point that several keyframes saw is looked for by the picture of the one that saw it most like from here.
#include "places/guided_matching.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

Pose at(double x, double z) { return {Eigen::Quaterniond::Identity(), {x, 0, z}}; }

// A point of a textured plane, seen by keyframes 0 and 1. A keyframe whose picture is blank cannot be what it was found
// by.
class GuidedMatching : public ::testing::Test {
 protected:
  void addKeyframe(const Pose& world_T_camera, bool blank) {
    Keyframe keyframe;
    keyframe.id = static_cast<KeyframeId>(map_.keyframes.size());
    keyframe.world_T_camera = world_T_camera;
    keyframe.images =
        imagesOf(blank ? cv::Mat(240, 320, CV_8U, cv::Scalar(100)) : plane_.render(camera_, world_T_camera));
    PointObservation observation;
    observation.point = point_;
    observation.measurement = measuredFrom(world_T_camera);
    observation.bearing = bearing(camera_, observation.measurement.pixel);
    keyframe.observations = std::vector<PointObservation>{observation};
    map_.keyframes.push_back(keyframe);
  }

  Measurement measuredFrom(const Pose& pose) const {
    return {project(camera_, pose.inverse() * position_), {1, 0}, 0.5, 1000};
  }

  // Keyframe 0 hosts the point, keyframe 1 sees it.
  void addPoint() {
    MapPoint point;
    point.id = point_;
    const Eigen::Vector3d in_host = map_.keyframes[0].world_T_camera.inverse() * position_;
    point.host_bearing = in_host.normalized();
    point.inverse_depth = 1 / in_host.norm();
    point.inverse_depth_sigma = 0.01 * point.inverse_depth;
    point.seen_in = {1};
    map_.points[point_] = point;
  }

  void twoKeyframes(const Pose& first, bool first_blank, const Pose& second, bool second_blank) {
    map_ = Map();
    addKeyframe(first, first_blank);
    addKeyframe(second, second_blank);
    addPoint();
  }

  PlaceView viewOf(KeyframeId keyframe) const {
    PlaceView view;
    view.keyframe = keyframe;
    view.images = map_.keyframes[keyframe].images.get();
    PlacePoint point;
    point.id = point_;
    point.position = map_.keyframes[keyframe].world_T_camera.inverse() * position_;
    point.depth_deviation = 0.01;
    point.measurement = measuredFrom(map_.keyframes[keyframe].world_T_camera);
    view.points = {point};
    return view;
  }

  // From `pose`, predicted `off` [px] its place. `measured` becomes what was found.
  bool findFrom(const Pose& pose, const Eigen::Vector2d& off, double largest_move, Measurement& measured,
                const GuidedMatchingOptions& options = {}) const {
    const PlaceView from = viewOf(0);
    measured = measuredFrom(pose);
    measured.pixel += off;
    const auto images = imagesOf(plane_.render(camera_, pose));
    return findByPatch(camera_, map_, from, from.points[0], pose.inverse() * map_.keyframes[0].world_T_camera, *images,
                       largest_move, options, measured);
  }
  bool isFoundFrom(const Pose& pose, const GuidedMatchingOptions& options = {}) const {
    Measurement measured;
    return findFrom(pose, {0.5, 0}, 4, measured, options) &&
           std::abs(measured.pixel.x() - measuredFrom(pose).pixel.x()) < 0.3;
  }

  const PointId point_ = 5;
  const Eigen::Vector3d position_{0.05, 0.1, 2};
  const Camera camera_ = smallCamera();
  TexturedPlane plane_{SmoothTexture(31, 12, 60)};
  Map map_;
};

TEST_F(GuidedMatching, TakesThePictureFromTheSmallestAngle) {
  twoKeyframes(at(-0.6, 0), true, at(0.6, 0), false);
  EXPECT_TRUE(isFoundFrom(at(0.55, 0)));
  EXPECT_FALSE(isFoundFrom(at(-0.55, 0)));
  twoKeyframes(at(-0.6, 0), false, at(0.6, 0), true);
  EXPECT_FALSE(isFoundFrom(at(0.55, 0)));
  EXPECT_TRUE(isFoundFrom(at(-0.55, 0)));
}

TEST_F(GuidedMatching, InTheSameDirectionTakesThePictureFromTheMostSimilarDistance) {
  const Pose far = at(0, -0.2), near = at(0, 0.9);
  twoKeyframes(far, true, near, false);
  EXPECT_TRUE(isFoundFrom(at(0, 0.85)));
  EXPECT_FALSE(isFoundFrom(at(0, -0.15)));
  twoKeyframes(far, false, near, true);
  EXPECT_FALSE(isFoundFrom(at(0, 0.85)));
  EXPECT_TRUE(isFoundFrom(at(0, -0.15)));
}

TEST_F(GuidedMatching, FromBeyondTheLargestAngleNoPictureServes) {
  twoKeyframes(at(0, 0), false, at(0.05, 0), false);
  GuidedMatchingOptions options;
  options.largest_view_angle_deg = 8;
  EXPECT_TRUE(isFoundFrom(at(0.2, 0), options)) << "some 6 degrees";
  EXPECT_TRUE(isFoundFrom(at(-0.2, 0), options));
  EXPECT_FALSE(isFoundFrom(at(0.5, 0), options)) << "some 13 degrees";
  EXPECT_FALSE(isFoundFrom(at(-0.5, 0), options));
  EXPECT_TRUE(isFoundFrom(at(-0.5, 0)));
}

TEST_F(GuidedMatching, KeyframesWithoutImagesAndWithoutTheObservationArePassedOver) {
  twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
  map_.keyframes[1].images = nullptr;
  EXPECT_TRUE(isFoundFrom(at(0.1, 0)));
  map_.keyframes[0].observations.clear();
  EXPECT_FALSE(isFoundFrom(at(0.1, 0)));
  twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
  map_.keyframes[1].observations.clear();
  EXPECT_TRUE(isFoundFrom(at(0.1, 0)));
}

TEST_F(GuidedMatching, WhatMovesTooFarIsNotBelieved) {
  twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
  const Pose here = at(0.05, 0);
  Measurement measured;
  for (const double off : {-3.0, 3.0}) {
    EXPECT_FALSE(findFrom(here, {off, 0}, 1.5, measured)) << "across the edge " << off;
    EXPECT_TRUE(findFrom(here, {off, 0}, 4, measured)) << off;
    EXPECT_LT((measured.pixel - measuredFrom(here).pixel).norm(), 0.3);
    EXPECT_TRUE(findFrom(here, {0, off}, 2, measured)) << "along it twice as far is allowed " << off;
    EXPECT_FALSE(findFrom(here, {0, off}, 1, measured)) << off;
  }
}

// Of a fine texture the full image alone does not lead so far: the coarser one does.
TEST_F(GuidedMatching, IsFoundFromSeveralPixelsOff) {
  const Pose here = at(0.05, 0);
  int found = 0, tried = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    plane_ = {SmoothTexture(seed, 9, 30)};
    twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
    for (const double off : {-8.0, -7.0, 7.0, 8.0}) {
      Measurement measured;
      ++tried;
      found +=
          findFrom(here, {off, 0}, 9, measured) && (measured.pixel - measuredFrom(here).pixel).norm() < 0.3 ? 1 : 0;
    }
  }
  EXPECT_GT(found, 0.6 * tried);
}

TEST_F(GuidedMatching, ACornerMayNotMoveFartherAlongThanAcross) {
  twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
  const PlaceView from = viewOf(0);
  PlacePoint corner = from.points[0];
  corner.corner = true;
  const Pose here = at(0.05, 0);
  const auto images = imagesOf(plane_.render(camera_, here));
  for (const bool is_corner : {false, true}) {
    corner.corner = is_corner;
    Measurement measured = measuredFrom(here);
    measured.pixel.y() += 3;
    EXPECT_EQ(findByPatch(camera_, map_, from, corner, here.inverse() * map_.keyframes[0].world_T_camera, *images, 2,
                          {}, measured),
              !is_corner);
  }
}

// Of the points of the other view, one on the same piece of edge is the same one.
TEST_F(GuidedMatching, ThePartnerIsTheNearestAcrossTheSameEdge) {
  twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
  const PlaceView from = viewOf(0);
  PlaceView to = viewOf(1);
  const Measurement here = measuredFrom(map_.keyframes[1].world_T_camera);
  const auto partnerAmong = [&](const std::vector<Eigen::Vector2d>& offsets, const Eigen::Vector2d& normal) {
    to.points.clear();
    for (const Eigen::Vector2d& offset : offsets) {
      PlacePoint point = from.points.front();
      point.measurement = here;
      point.measurement.pixel += offset;
      point.measurement.normal = normal.normalized();
      to.points.push_back(point);
    }
    const Pose to_T_from = map_.keyframes[1].world_T_camera.inverse() * map_.keyframes[0].world_T_camera;
    const GuidedMatches found =
        matchGuided(camera_, map_, from, to, {1, to_T_from.rotation, to_T_from.translation}, 4, {});
    EXPECT_EQ(found.visible, 1);
    EXPECT_EQ(found.matches.size(), 1U);
    return found.matches.empty() ? -2 : found.matches[0].to;
  };
  const Eigen::Vector2d across(1, 0);
  EXPECT_EQ(partnerAmong({{1.5, 0}, {0.7, 4}, {-1.2, 0}}, across), 1);
  EXPECT_EQ(partnerAmong({{-0.5, 8}, {0, 12}}, across), 0) << "too far along the edge";
  EXPECT_EQ(partnerAmong({{2.5, 0}, {-2.5, 0}}, across), -1) << "another edge beside it";
  EXPECT_EQ(partnerAmong({{0, 0}}, {0.5, 0.8}), -1) << "an edge of another direction";
  EXPECT_EQ(partnerAmong({{0, 0}}, {-1, 0}), -1) << "from bright to dark";
  EXPECT_EQ(partnerAmong({{0, 0}}, {0.9, 0.3}), 0);
  EXPECT_EQ(partnerAmong({}, across), -1);
}

TEST_F(GuidedMatching, TheScaleOfTheSimilarityDoesNotMatter) {
  twoKeyframes(at(-0.1, 0), false, at(0.1, 0), false);
  const PlaceView from = viewOf(0), to = viewOf(1);
  const Pose motion = map_.keyframes[1].world_T_camera.inverse() * map_.keyframes[0].world_T_camera;
  const GuidedMatches one = matchGuided(camera_, map_, from, to, {1, motion.rotation, motion.translation}, 4, {});
  ASSERT_EQ(one.matches.size(), 1U);
  EXPECT_EQ(one.visible_in_both, 1);
  EXPECT_LT((one.matches[0].measurement.pixel - to.points[0].measurement.pixel).norm(), 0.3);
  const GuidedMatches two = matchGuided(camera_, map_, from, to, {2, motion.rotation, 2 * motion.translation}, 4, {});
  ASSERT_EQ(two.matches.size(), 1U);
  EXPECT_LT((two.matches[0].measurement.pixel - one.matches[0].measurement.pixel).norm(), 1e-6);
}

}  // namespace
}  // namespace edgeslam
