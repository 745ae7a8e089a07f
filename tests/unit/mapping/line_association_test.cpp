// Edges are views of the line that their tracks were seen on, else of the one that projects onto them with the same
// brighter side; where neither tells, a line begins.
#include "mapping/line_association.h"

#include <gtest/gtest.h>

#include "line_scene.h"
#include "unit/map/change_each.h"

namespace edgeslam::test {
namespace {

const std::vector<SpaceEdge> four_borders{{{-1.2, -0.6, 3}, {-1.2, 0.6, 3}},
                                          {{-0.4, 0.6, 3.2}, {-0.4, -0.6, 3.2}},
                                          {{0.5, -0.6, 2.8}, {0.5, 0.6, 2.8}},
                                          {{1.2, 0.6, 3.1}, {1.2, -0.6, 3.1}}};

// Keyframe `id` at x = 0.1 * id, that sees all panels.
Keyframe keyframeAt(KeyframeId id, const std::vector<SpaceEdge>& edges = four_borders) {
  Random random(1);
  return keyframeThatSees(distorted_camera, edges, id, poseAt(0.1 * id, 0, 0), {}, random);
}

// Two keyframes with all lines placed, and a third one without any.
Map mapWithNewKeyframe() {
  Map map;
  map.keyframes.push_back(keyframeAt(0));
  map.keyframes.push_back(keyframeAt(1));
  addPlacedLines(four_borders, map);
  map.keyframes.push_back(keyframeAt(2));
  return map;
}

void renumberTracks(Keyframe& keyframe) {
  test::changeEach(keyframe.observations, [&](PointObservation& seen) { seen.point += 100000; });
}

std::vector<LineId> linesSeenBy(const Keyframe& keyframe) {
  std::vector<LineId> lines;
  for (const SeenEdge& edge : keyframe.straight_edges) lines.push_back(edge.line);
  return lines;
}

const std::vector<LineId> all_lines{0, 1, 2, 3};

TEST(LineAssociation, BeginsALineForEachEdgeAtFirst) {
  Map map;
  map.keyframes.push_back(keyframeAt(0));
  associateLines(distorted_camera, {}, 0, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[0]), all_lines);
  ASSERT_EQ(map.lines.size(), four_borders.size());
  for (const auto& [id, line] : map.lines) {
    EXPECT_EQ(line.id, id);
    EXPECT_EQ(line.host, 0);
    EXPECT_FALSE(line.is_placed);
    EXPECT_EQ(line.seen_in, std::vector<KeyframeId>{0});
  }
  EXPECT_EQ(map.next_line, 4);
}

TEST(LineAssociation, FollowsTheTracksWherePlacesWouldNotTell) {
  Map map = mapWithNewKeyframe();
  for (auto& [id, line] : map.lines) line.is_placed = false;
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[2]), all_lines);
  for (const auto& [id, line] : map.lines) EXPECT_EQ(line.seen_in, (std::vector<KeyframeId>{0, 1, 2}));
}

TEST(LineAssociation, NeedsThreeTracksAndHalfOfThem) {
  Map map = mapWithNewKeyframe();
  for (auto& [id, line] : map.lines) line.is_placed = false;
  Keyframe& keyframe = map.keyframes[2];
  int kept_of_first = 0, moved_to_third = 0;
  test::changeEach(keyframe.observations, [&](PointObservation& seen) {
    // Two tracks of the first panel are left; the third has its six and, as if they had strayed, six of the fourth.
    if (seen.point / 100 == 0 && ++kept_of_first > 2) seen.point += 100000;
    if (seen.point / 100 == 3) {
      seen.straight_edge = 2;
      ++moved_to_third;
    }
  });
  ASSERT_EQ(moved_to_third, tracks_on_edge);
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(keyframe), (std::vector<LineId>{4, 1, 2, 5}));
}

TEST(LineAssociation, KnowsAPlacedLineAgainByWhereItProjects) {
  Map map = mapWithNewKeyframe();
  renumberTracks(map.keyframes[2]);
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[2]), all_lines);
  EXPECT_EQ(map.lines.size(), four_borders.size());
}

TEST(LineAssociation, AsksForTheSameBrighterSide) {
  std::vector<SpaceEdge> turned = four_borders;
  for (SpaceEdge& edge : turned) std::swap(edge.from, edge.to);
  Map map = mapWithNewKeyframe();
  map.keyframes[2] = keyframeAt(2, turned);
  renumberTracks(map.keyframes[2]);
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[2]), (std::vector<LineId>{4, 5, 6, 7}));
}

// 0.015 m at 3 m are 2 px, which one line may be off; the other side of a seam is as near.
TEST(LineAssociation, TakesNoneOfTwoThatAreAsNear) {
  std::vector<SpaceEdge> moved = four_borders;
  for (SpaceEdge& edge : moved) {
    edge.from.x() += 0.015;
    edge.to.x() += 0.015;
  }
  Map map = mapWithNewKeyframe();
  map.keyframes[2] = keyframeAt(2, moved);
  renumberTracks(map.keyframes[2]);
  Map with_seam = map;
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[2]), all_lines);

  MapLine seam = with_seam.lines.at(1);
  seam.id = with_seam.next_line++;
  seam.in_host.point.x() += 0.032;
  with_seam.lines.emplace(seam.id, seam);
  associateLines(distorted_camera, {}, 2, with_seam);
  EXPECT_EQ(linesSeenBy(with_seam.keyframes[2]), (std::vector<LineId>{0, 5, 2, 3}));
}

// What is known of a line ends; an edge far along the same straight line is another one.
TEST(LineAssociation, AsksForTheSamePartOfALine) {
  Map map = mapWithNewKeyframe();
  for (auto& [id, line] : map.lines) {
    line.begin = -0.05;
    line.end = 0.05;
  }
  std::vector<SpaceEdge> upper = four_borders;
  for (SpaceEdge& edge : upper) (edge.from.y() > 0 ? edge.from : edge.to).y() = -0.3;
  map.keyframes[2] = keyframeAt(2, upper);
  renumberTracks(map.keyframes[2]);
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[2]), (std::vector<LineId>{4, 5, 6, 7}));
}

TEST(LineAssociation, KeepsToItsWorld) {
  Map map = mapWithNewKeyframe();
  map.keyframes[2].world = 1;
  associateLines(distorted_camera, {}, 2, map);
  EXPECT_EQ(linesSeenBy(map.keyframes[2]), (std::vector<LineId>{4, 5, 6, 7}));
}

}  // namespace
}  // namespace edgeslam::test
