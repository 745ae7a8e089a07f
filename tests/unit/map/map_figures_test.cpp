#include "map/map_figures.h"

#include <gtest/gtest.h>

#include "unit/map/made_map.h"

namespace edgeslam::test {
namespace {

TEST(FiguresOf, CountsWhatIsInTheMap) {
  const SavedMap saved = madeMap(64, 48);
  const std::vector<WorldFigures> all = figuresOf(saved.map);
  ASSERT_EQ(all.size(), 1U);
  const WorldFigures& figures = all[0];
  EXPECT_EQ(figures.keyframes, 4U);
  EXPECT_EQ(figures.keyframes_with_images, 2U);
  EXPECT_EQ(figures.points, 3U);
  EXPECT_EQ(figures.lines, 1U) << "the other one is not placed";
  EXPECT_EQ(figures.first, 0);
  EXPECT_EQ(figures.last, 9);
  EXPECT_LT(figures.first_ns, figures.last_ns);
  EXPECT_NEAR(figures.way, 0.9, 1e-12);
  EXPECT_NEAR(figures.cameras.most.x(), 0.9, 1e-12);
  EXPECT_EQ(figures.cameras.least.x(), 0);
}

TEST(FiguresOf, EachWorldHasItsOwn) {
  SavedMap saved = madeMap(64, 48);
  Keyframe other = saved.map.keyframes.back();
  other.id = 12;
  other.world = 3;
  other.world_T_camera.translation = {50, 60, 70};
  saved.map.keyframes.push_back(other);
  const std::vector<WorldFigures> all = figuresOf(saved.map);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].world, 0);
  EXPECT_EQ(all[1].world, 3);
  EXPECT_EQ(all[1].keyframes, 1U);
  EXPECT_EQ(all[1].points, 0U);
  EXPECT_EQ(all[1].way, 0);
  EXPECT_EQ(all[1].cameras.least, Eigen::Vector3d(50, 60, 70));
}

// A few points far away, as every map has them, do not say where it is.
TEST(FiguresOf, AHundredthOfThePointsAtEitherEndIsLeftOut) {
  SavedMap saved = madeMap(64, 48);
  saved.map.points.clear();
  for (PointId id = 0; id < 1000; ++id) {
    MapPoint point;
    point.id = id;
    point.host = 0;
    point.host_bearing = Eigen::Vector3d::UnitZ();
    point.inverse_depth = id < 5 ? 1e-9 : 0.5;
    saved.map.points.emplace(id, point);
  }
  const WorldFigures figures = figuresOf(saved.map).at(0);
  EXPECT_LT((figures.most_points.most - figures.most_points.least).norm(), 1e-12);
  EXPECT_NEAR(figures.most_points.most.norm(), 2, 1e-9);
}

}  // namespace
}  // namespace edgeslam::test
