// What tracks say along their lines from one keyframe to the next tells motion that the lines do not, and no more.
#include "mapping/motion_along_lines.h"

#include <gtest/gtest.h>

#include "line_scene.h"
#include "unit/map/change_each.h"

namespace edgeslam::test {
namespace {

// The floor's two borders in a corridor, and no end of it: nothing tells how far the camera went along.
const std::vector<SpaceEdge> corridor{{{-1, 1, 3}, {-1, 1, 8}}, {{1, 1, 8}, {1, 1, 3}}};

Map corridorMap(const std::vector<Pose>& poses, double slide_of_last = 0) {
  Random random(1);
  Map map;
  for (const Pose& pose : poses) {
    EdgeSight sight;
    sight.slide = map.keyframes.size() + 1 == poses.size() ? slide_of_last : 0;
    map.keyframes.push_back(keyframeThatSees(distorted_camera, corridor, static_cast<KeyframeId>(map.keyframes.size()),
                                             pose, sight, random));
  }
  addPlacedLines(corridor, map);
  return map;
}

std::vector<LineId> linesOf(const Map& map) {
  std::vector<LineId> lines;
  for (const auto& [id, line] : map.lines) lines.push_back(id);
  return lines;
}

// All keyframes but the last are fixed; it is moved along the corridor by `off`.
BundleProblem problemOf(const Map& map, double off) {
  BundleProblem problem;
  for (const Keyframe& keyframe : map.keyframes) {
    const bool is_last = keyframe.id == map.keyframes.back().id;
    problem.cameras.push_back({keyframe.world_T_camera, !is_last});
    if (is_last) problem.cameras.back().world_T_camera.translation.z() += off;
  }
  for (const auto& [id, line] : map.lines) {
    const int index = static_cast<int>(problem.lines.size());
    problem.lines.push_back({inWorld(map, line), true});
    for (const Keyframe& keyframe : map.keyframes) {
      for (const SeenEdge& edge : keyframe.straight_edges) {
        if (edge.line != id) continue;
        for (const EdgeEnd* end : {&edge.from, &edge.to}) {
          problem.line_observations.push_back({keyframe.id, index, end->bearing, end->pixel.y(), edge.sigma});
        }
      }
    }
  }
  return problem;
}

int sameIndex(KeyframeId keyframe) { return keyframe; }

const std::vector<Pose> corridor_walk{poseAt(0, 0, 0), poseAt(0.02, 0, 0.3), poseAt(-0.01, 0.02, 0.6)};

double errorAlong(const BundleProblem& problem) {
  return problem.cameras.back().world_T_camera.translation.z() - corridor_walk.back().translation.z();
}

TEST(MotionAlongLines, IsWhatLinesAloneDoNotTell) {
  const Map map = corridorMap(corridor_walk);
  BundleProblem lines_only = problemOf(map, 0.2);
  ASSERT_TRUE(adjustBundle(distorted_camera, lines_only, {30, 2}).usable);
  EXPECT_NEAR(errorAlong(lines_only), 0.2, 0.02);

  BundleProblem problem = problemOf(map, 0.2);
  addMotionAlongLines(distorted_camera, map, linesOf(map), sameIndex, problem);
  ASSERT_TRUE(adjustBundle(distorted_camera, problem, {30, 2}).usable);
  EXPECT_NEAR(errorAlong(problem), 0, 1e-4);
}

// Tracks of a line slide together: however many they are, they say as much as one.
TEST(MotionAlongLines, CountsALineOnce) {
  Map map = corridorMap(corridor_walk);
  const auto cost = [&map] {
    BundleProblem problem = problemOf(map, 0.2);
    addMotionAlongLines(distorted_camera, map, linesOf(map), sameIndex, problem);
    problem.line_observations.clear();
    return adjustBundle(distorted_camera, problem, {1, 1e6}).initial_cost;
  };
  const double of_all = cost();
  for (Keyframe& keyframe : map.keyframes) {
    std::vector<PointObservation> seen(keyframe.observations.begin(), keyframe.observations.end());
    seen.erase(std::remove_if(seen.begin(), seen.end(), [](const auto& o) { return o.point % 2 == 0; }), seen.end());
    keyframe.observations = seen;
  }
  EXPECT_NEAR(cost() / of_all, 1, 0.3);
}

TEST(MotionAlongLines, IsOfConsecutiveKeyframesOnly) {
  const Map map = corridorMap(corridor_walk);
  const auto added = [&](const std::vector<LineId>& lines, const std::function<int(KeyframeId)>& camera_of) {
    BundleProblem problem = problemOf(map, 0);
    addMotionAlongLines(distorted_camera, map, lines, camera_of, problem);
    EXPECT_EQ(problem.points.size(), problem.observations.size());
    for (const BundleObservation& o : problem.observations) {
      EXPECT_EQ(o.camera, 2);
      EXPECT_EQ(problem.points[static_cast<std::size_t>(o.point)].host, 1);
      EXPECT_GT(o.measurement.sigma_normal, 100);
    }
    return problem.observations.size();
  };
  EXPECT_EQ(added(linesOf(map), sameIndex), corridor.size() * tracks_on_edge);  // the first two are both fixed
  EXPECT_EQ(added({linesOf(map).front()}, sameIndex), tracks_on_edge);
  EXPECT_EQ(added({}, sameIndex), 0U);
  EXPECT_EQ(added(linesOf(map), [](KeyframeId keyframe) { return keyframe == 1 ? -1 : keyframe; }), 0U);
}

TEST(MotionAlongLines, IsOfTracksThatStayOnTheirLine) {
  Map map = corridorMap(corridor_walk);
  test::changeEach(map.keyframes[1].observations, [&](PointObservation& seen) {
    if (seen.point == trackOf(0, 0)) seen.straight_edge = 1;
    if (seen.point == trackOf(0, 1)) seen.straight_edge = -1;
  });
  test::changeEach(map.keyframes[2].observations, [&](PointObservation& seen) {
    if (seen.point == trackOf(0, 2)) seen.corner = true;
  });
  BundleProblem problem = problemOf(map, 0);
  addMotionAlongLines(distorted_camera, map, linesOf(map), sameIndex, problem);
  EXPECT_EQ(problem.observations.size(), corridor.size() * tracks_on_edge - 3);
}

}  // namespace
}  // namespace edgeslam::test
