// How far from where it is predicted a map point is still found, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "edges/edge_detection.h"
#include "tracking/map_search.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// A point on the edge of a narrow bar and a corner of it, seen by a keyframe; the frame shows the same picture. Both
// are predicted somewhere that is off by so much. From beside the bar its slope does not lead there: it must be
// searched.
class MapSearchReach : public ::testing::Test {
 protected:
  static cv::Mat picture() {
    cv::Mat grey(240, 320, CV_8U, cv::Scalar(60));
    grey(cv::Rect(160, 60, 3, 180)).setTo(180);
    cv::Mat blurred;
    cv::GaussianBlur(grey, blurred, cv::Size(), 0.8);
    return blurred;
  }

  SearchPoint pointAt(const Eigen::Vector2f& pixel, bool corner) const {
    SearchPoint point;
    point.position = 2 * bearing(camera_, pixel.cast<double>());
    point.source_images = images_.get();
    point.source_pixel = pixel;
    point.source_normal = Eigen::Vector2f::UnitX();
    point.corner = corner;
    return point;
  }

  // Where the point is found that is predicted at its place and `off` [px]; nothing where it is not.
  FoundPoints found(const SearchPoint& point, const Eigen::Vector2f& off, const MapSearchOptions& options = {}) const {
    VisiblePoints visible;
    visible.push_back({0, point.source_pixel + off, point.source_normal, Eigen::Matrix2f::Identity()});
    SearchPoints points;
    points.push_back(point);
    return findVisiblePoints(points, visible, *images_, edges_, options);
  }

  const Camera camera_ = smallCamera();
  const std::shared_ptr<const FrameImages> images_ = imagesOf(picture());
  const EdgeMap edges_ = detectEdges(images_->pyramid.levels[0], EdgeOptions());
  const Eigen::Vector2f on_edge_{159.5f, 150}, corner_{159.5f, 59.5f};
};

TEST_F(MapSearchReach, APointOfAnEdgeIsFoundAcrossItAsFarAsTheRadius) {
  const SearchPoint point = pointAt(on_edge_, false);
  for (int off = -6; off <= 6; ++off) {
    const FoundPoints there = found(point, {static_cast<float>(off), 0});
    ASSERT_EQ(there.size(), 1U) << off;
    EXPECT_NEAR(there[0].pixel.x(), on_edge_.x(), 0.1) << off;
    EXPECT_NEAR(there[0].pixel.y(), on_edge_.y(), 0.5) << "along the edge it stays where it was predicted";
    EXPECT_GT(there[0].correlation, 0.98f);
  }
}

// Farther than the alignment itself would lead.
TEST_F(MapSearchReach, AWiderRadiusIsSearchedWhole) {
  MapSearchOptions wide;
  wide.radius = 14;
  for (const float off : {-14.0f, -11.0f, 11.0f, 14.0f}) {
    const FoundPoints across = found(pointAt(on_edge_, false), {off, 0}, wide);
    ASSERT_EQ(across.size(), 1U) << off;
    EXPECT_NEAR(across[0].pixel.x(), on_edge_.x(), 0.1) << off;
    const FoundPoints upright = found(pointAt(corner_, true), {0, off}, wide);
    ASSERT_EQ(upright.size(), 1U) << off;
    EXPECT_LT((upright[0].pixel - corner_).norm(), 0.3f) << off;
  }
}

TEST_F(MapSearchReach, BeyondTheRadiusNothingIsFound) {
  for (const bool corner : {false, true}) {
    const SearchPoint point = pointAt(corner ? corner_ : on_edge_, corner);
    MapSearchOptions narrow;
    narrow.radius = 3;
    for (const float off : {-12.0f, -5.0f, 5.0f, 12.0f}) EXPECT_TRUE(found(point, {off, 0}, narrow).empty()) << off;
    for (const float off : {-3.0f, 3.0f}) EXPECT_EQ(found(point, {off, 0}, narrow).size(), 1U) << off;
    for (const float off : {-15.0f, 15.0f}) EXPECT_TRUE(found(point, {off, 0}).empty()) << off;
  }
}

TEST_F(MapSearchReach, ACornerIsFoundInAllDirections) {
  const SearchPoint point = pointAt(corner_, true);
  for (const auto& off : {Eigen::Vector2f(6, 0), {-6, 0}, {0, 6}, {0, -6}, {4, 4}, {-4, 4}, {4, -4}, {-4, -4}}) {
    const FoundPoints there = found(point, off);
    ASSERT_EQ(there.size(), 1U) << off.transpose();
    EXPECT_LT((there[0].pixel - corner_).norm(), 0.3f) << off.transpose();
  }
}

// The edges are where they should be, dark and bright have changed places.
TEST_F(MapSearchReach, WhatLooksDifferentIsNotFound) {
  SearchPoints points;
  points.push_back(pointAt(on_edge_, false));
  VisiblePoints visible;
  visible.push_back({0, on_edge_, Eigen::Vector2f::UnitX(), Eigen::Matrix2f::Identity()});
  const auto negative = imagesOf(255 - picture());
  EXPECT_EQ(findVisiblePoints(points, visible, *images_, edges_, {}).size(), 1U);
  EXPECT_TRUE(findVisiblePoints(points, visible, *negative, edges_, {}).empty());
}

TEST_F(MapSearchReach, OnlyOnAnEdgeOfTheSameDirection) {
  const SearchPoint point = pointAt(on_edge_, false);
  EXPECT_TRUE(findVisiblePoints({}, {}, *images_, edges_, {}).empty());
  const cv::Mat flat(240, 320, CV_8U, cv::Scalar(90));
  SearchPoints points;
  points.push_back(point);
  VisiblePoints visible;
  visible.push_back({0, on_edge_, Eigen::Vector2f::UnitX(), Eigen::Matrix2f::Identity()});
  EXPECT_EQ(findVisiblePoints(points, visible, *images_, edges_, {}).size(), 1U);
  EXPECT_TRUE(findVisiblePoints(points, visible, *images_, detectEdges(flat, EdgeOptions()), {}).empty());
  visible[0].normal = Eigen::Vector2f::UnitY();
  EXPECT_TRUE(findVisiblePoints(points, visible, *images_, edges_, {}).empty()) << "the edge runs another way";
}

// Seen from beside, from nearer and from farther than a keyframe's patch can tell.
TEST_F(MapSearchReach, VisibleAreThoseSeenFromAboutTheSameDirectionAndDistance) {
  const SearchPoint point = pointAt({160, 120}, false);
  SearchPoints points;
  points.push_back(point);
  const auto visibleFrom = [&](const Pose& pose) { return !visiblePoints(camera_, points, pose, {}).empty(); };
  const Eigen::Vector3d ray = point.position.normalized();
  for (const double distance : {0.9, 1.3, 2.0, 3.0, 4.5}) {
    EXPECT_TRUE(visibleFrom({Eigen::Quaterniond::Identity(), (2 - distance) * ray})) << distance;
  }
  for (const double distance : {0.1, 0.5, 0.75, 5.5, 20.0}) {
    EXPECT_FALSE(visibleFrom({Eigen::Quaterniond::Identity(), (2 - distance) * ray})) << distance;
  }
  // Around the point, looking at it all the time.
  for (int degrees = -170; degrees <= 170; degrees += 10) {
    const Eigen::Quaterniond turn = rotationExp({0, degrees * M_PI / 180, 0});
    const Pose around{turn, point.position - turn * point.position};
    EXPECT_EQ(visibleFrom(around), std::abs(degrees) < 45) << degrees;
  }
}

TEST_F(MapSearchReach, APredictionNearTheBorderIsNotSearched) {
  const MapSearchOptions options;
  for (const float x : {2.0f, 7.0f, 9.0f, 310.0f, 312.5f, 318.0f}) {
    SearchPoints points;
    points.push_back(pointAt({x, 120}, false));
    const bool inside = x >= options.border && x <= 319 - options.border;
    EXPECT_EQ(!visiblePoints(camera_, points, Pose(), options).empty(), inside) << x;
  }
}

TEST(MapSearchMeasurement, CarriesOverHowGoodTheKeyframesPatchWas) {
  SearchPoint point;
  point.sigma_normal = 0.3f;
  point.sigma_tangent = 40;
  FoundPoint found;
  found.pixel = {10, 20};
  found.normal = {0.6f, 0.8f};
  const Measurement measured = measurementOf(point, found);
  EXPECT_EQ(measured.pixel, Eigen::Vector2d(10, 20));
  EXPECT_LT((measured.normal - Eigen::Vector2d(0.6, 0.8)).norm(), 1e-6);
  EXPECT_NEAR(measured.sigma_normal, 0.3, 1e-6);
  EXPECT_NEAR(measured.sigma_tangent, 40, 1e-6);
}

}  // namespace
}  // namespace edgeslam
