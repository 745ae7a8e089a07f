// P13: a camera that stands, before which things move.
#include "mapping/standing_camera.h"

#include <gtest/gtest.h>

#include <functional>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

constexpr int grid_columns = 20, grid_rows = 15;
const Eigen::Vector2d normal_of_all(0, 1);

// How far the point of a column and a row, counted from the left top, has moved [px].
using Motion = std::function<Eigen::Vector2d(int column, int row)>;

struct PointGrid {
  Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  InitialFrames frames;

  explicit PointGrid(bool corners = true) {
    frames.first = seen([](int, int) { return Eigen::Vector2d(0, 0); }, corners);
  }

  TrackedFrame seen(const Motion& motion, bool corners) const {
    TrackedFrame frame;
    for (int row = 0; row < grid_rows; ++row) {
      for (int column = 0; column < grid_columns; ++column) {
        PointObservation observation;
        observation.point = row * grid_columns + column;
        observation.corner = corners;
        observation.measurement.normal = normal_of_all;
        observation.measurement.pixel =
            Eigen::Vector2d((column + 0.5) * camera.width / grid_columns, (row + 0.5) * camera.height / grid_rows) +
            motion(column, row);
        frame.observations.push_back(observation);
      }
    }
    return frame;
  }

  void see(const Motion& motion, bool corners = true) { frames.since.push_back(seen(motion, corners)); }
};

// A thing before the middle of the image goes to the right, by so much.
Motion thingMoves(double x_px) {
  return [=](int column, int row) {
    const bool is_thing = column >= 5 && column < 15 && row >= 3 && row < 12;
    return Eigen::Vector2d(is_thing ? x_px : 0.1, 0.1);
  };
}

// All move, but so many in each row of 20.
Motion allMoveBut(int still) {
  return [=](int column, int row) {
    return (column + 7 * row) % grid_columns < still ? Eigen::Vector2d(0.2, 0.2) : Eigen::Vector2d(10, 4);
  };
}

TEST(StandingCamera, AThingThatMovesBeforeItIsSeenAsSuch) {
  PointGrid grid;
  grid.see(thingMoves(12));
  StandingCamera standing;
  EXPECT_TRUE(standing.stands(grid.camera, grid.frames));
  EXPECT_EQ(standing.description(), "the camera seems to stand: 210 of 300 points, all over the image, did not move");
}

TEST(StandingCamera, ACameraThatMovesHasHardlyAPointThatIsStill) {
  for (const int still : {0, 1, 2}) {
    PointGrid grid;
    grid.see(allMoveBut(still));
    EXPECT_FALSE(StandingCamera().stands(grid.camera, grid.frames)) << still << " of 20";
  }
  PointGrid grid;
  grid.see(allMoveBut(4));
  EXPECT_TRUE(StandingCamera().stands(grid.camera, grid.frames));
}

TEST(StandingCamera, TheRobotsOwnBodyOnOneSideOfTheImageIsNoBackground) {
  PointGrid below, left;
  below.see([](int, int row) { return Eigen::Vector2d(row >= 10 ? 0 : 9, 0); });
  left.see([](int column, int) { return Eigen::Vector2d(column < 6 ? 0 : 9, 0); });
  for (const PointGrid& grid : {below, left}) EXPECT_FALSE(StandingCamera().stands(grid.camera, grid.frames));
}

TEST(StandingCamera, ItStandsUntilWhatWasStillHasMoved) {
  PointGrid grid;
  StandingCamera standing;
  grid.see(thingMoves(12));
  ASSERT_TRUE(standing.stands(grid.camera, grid.frames));
  // The thing covers all but a twentieth of the image.
  TrackedFrame covered = grid.seen(thingMoves(20), true);
  std::vector<PointObservation>& left = covered.observations;
  left.erase(left.begin(), left.begin() + 60);
  left.erase(left.end() - 45, left.end());
  grid.frames.since.push_back(covered);
  EXPECT_TRUE(standing.stands(grid.camera, grid.frames));
  grid.see([](int, int) { return Eigen::Vector2d(3, 0); });
  EXPECT_FALSE(standing.stands(grid.camera, grid.frames));
}

TEST(StandingCamera, PointsThatAreDrawnAlongTheirEdgesDidNotMove) {
  PointGrid grid(false);
  StandingCamera standing;
  grid.see(thingMoves(12), false);
  ASSERT_TRUE(standing.stands(grid.camera, grid.frames));
  grid.see([](int, int) { return Eigen::Vector2d(4, 0); }, false);
  EXPECT_TRUE(standing.stands(grid.camera, grid.frames));
  grid.see([](int, int) { return Eigen::Vector2d(0, 4); }, false);
  EXPECT_FALSE(standing.stands(grid.camera, grid.frames));
}

TEST(StandingCamera, OnceItStoodLessIsEnoughAgainstTheNextFirstFrame) {
  PointGrid grid;
  StandingCamera standing;
  grid.see(thingMoves(12));
  ASSERT_TRUE(standing.stands(grid.camera, grid.frames));
  standing.forget();
  grid.see(allMoveBut(2));
  EXPECT_TRUE(standing.stands(grid.camera, grid.frames));
  standing.forget();
  grid.see(allMoveBut(1));
  EXPECT_FALSE(standing.stands(grid.camera, grid.frames));
  grid.see(allMoveBut(2));
  EXPECT_FALSE(standing.stands(grid.camera, grid.frames));
}

}  // namespace
}  // namespace edgeslam
