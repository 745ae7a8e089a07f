#include "report/map_picture.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "unit/map/made_map.h"

namespace edgeslam::test {
namespace {

int pixelsOf(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat found;
  cv::inRange(picture, colour, colour, found);
  return cv::countNonZero(found);
}

TEST(DrawMapFromAbove, ShowsPointsLinesAndTheWay) {
  const SavedMap saved = madeMap(64, 48);
  const cv::Mat picture = drawMapFromAbove(saved.map);
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_GT(pixelsOf(picture, {90, 90, 90}), 10) << "points";
  EXPECT_GT(pixelsOf(picture, {200, 80, 0}), 20) << "way";
  EXPECT_GT(pixelsOf(picture, {0, 140, 255}), 5) << "line";
}

TEST(DrawMapFromAbove, WorldsAreBesideEachOtherAndNotWithoutBound) {
  SavedMap saved = madeMap(64, 48);
  const cv::Size one = drawMapFromAbove(saved.map).size();
  for (int world = 1; world < 100; ++world) {
    Keyframe other = saved.map.keyframes.back();
    other.id += 1;
    other.world = world;
    other.observations.clear();
    other.world_T_camera.translation = {1e12, -1e12, 1e12};
    saved.map.keyframes.push_back(other);
    if (world == 1) {
      EXPECT_EQ(drawMapFromAbove(saved.map).cols, 2 * one.width);
    }
  }
  const cv::Size many = drawMapFromAbove(saved.map).size();
  EXPECT_LE(many.area(), 12 * one.area());
}

TEST(DrawMapFromAbove, AnEmptyMapIsAnEmptyPicture) { EXPECT_FALSE(drawMapFromAbove(Map()).empty()); }

}  // namespace
}  // namespace edgeslam::test
