// Culling on maps of a walk round and round in a ring of landmarks: what stays is whole and where it was, what goes is
// told, and the map stays within its bounds however long the walk.
#include "mapping/culling.h"

#include <gtest/gtest.h>

#include <set>

#include "map/map_check.h"
#include "unit/map/seen_line.h"
#include "unit/mapping/landmark_walk.h"

namespace edgeslam::test {
namespace {

Walk walkOf(int steps, std::uint64_t seed = 1) {
  Walk walk(seed);
  while (static_cast<int>(walk.poses.size()) < steps) walk.step();
  return walk;
}

// Keyframes beside each other that all see the same.
Walk standing(int steps) {
  Walk walk(3);
  for (int i = 0; i < steps; ++i) walk.stepTo(0.001 * i);
  return walk;
}

CullingOptions withBounds(int most_keyframes, double most_megabytes) {
  CullingOptions options;
  options.recent_keyframes = 5;
  options.most_keyframes = most_keyframes;
  options.most_megabytes = most_megabytes;
  return options;
}

double megabytes(const Map& map) { return static_cast<double>(memoryOf(map)) * 1e-6; }

std::set<KeyframeId> viewersOf(const MapPoint& point) {
  std::set<KeyframeId> viewers(point.seen_in.begin(), point.seen_in.end());
  viewers.insert(point.host);
  return viewers;
}

std::set<KeyframeId> idsOf(const Map& map) {
  std::set<KeyframeId> ids;
  for (const Keyframe& keyframe : map.keyframes) ids.insert(keyframe.id);
  return ids;
}

// As if no other keyframes than these two had seen the point.
void seenOnlyBy(KeyframeId host, KeyframeId other, MapPoint& point, const Walk& walk) {
  const Eigen::Vector3d& landmark = walk.landmarks[static_cast<std::size_t>(point.id)];
  point.host = host;
  point.host_bearing = findObservation(walk.map.keyframes[host], point.id)->bearing;
  point.inverse_depth = 1 / (walk.map.keyframes[host].world_T_camera.inverse() * landmark).norm();
  point.seen_in = {other};
}

// Most keyframes, most megabytes. The first bounds are never reached: what goes is redundant.
struct CullingWithin : testing::TestWithParam<std::pair<int, double>> {
  const CullingOptions options = withBounds(GetParam().first, GetParam().second);
};
INSTANTIATE_TEST_SUITE_P(Bounds, CullingWithin,
                         testing::Values(std::pair{1000, 1000.0}, std::pair{25, 1000.0}, std::pair{1000, 10.0},
                                         std::pair{8, 4.0}));

TEST_P(CullingWithin, TheMapIsWholeAndItsEndsStay) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Walk walk = walkOf(100, seed);
    ASSERT_EQ(mapProblem(Walk::camera(), walk.map), "");
    const auto culled = cullKeyframes(options, walk.map, walk.candidates);
    EXPECT_EQ(mapProblem(Walk::camera(), walk.map), "");
    EXPECT_GT(culled.size(), 3U);
    EXPECT_EQ(walk.map.keyframes.size() + culled.size(), 100U);
    EXPECT_LE(static_cast<int>(walk.map.keyframes.size()), options.most_keyframes);
    EXPECT_LE(megabytes(walk.map), options.most_megabytes);
    EXPECT_TRUE(walk.map.keyframes.contains(0));
    for (KeyframeId recent = 95; recent < 100; ++recent) EXPECT_TRUE(walk.map.keyframes.contains(recent)) << recent;
  }
}

// Whatever goes, a point stays exactly where two keyframes that see it stay, and it stays where it is.
TEST_P(CullingWithin, PointsKeepTheirPlaceTheirDoubtAndTheirViews) {
  Walk walk = walkOf(100);
  const Map before = walk.map;
  cullKeyframes(options, walk.map, walk.candidates);
  int hosted_elsewhere = 0;
  for (const auto& [id, was] : before.points) {
    std::set<KeyframeId> left;
    for (const KeyframeId viewer : viewersOf(was)) {
      if (walk.map.keyframes.contains(viewer)) left.insert(viewer);
    }
    const auto found = walk.map.points.find(id);
    ASSERT_EQ(found != walk.map.points.end(), left.size() >= 2) << id;
    if (left.size() < 2) continue;
    const MapPoint& is = found->second;
    EXPECT_EQ(viewersOf(is), left);
    EXPECT_LT((worldPosition(walk.map, is) - worldPosition(before, was)).norm(), 1e-9) << id;
    const double relative_sigma = was.inverse_depth_sigma / was.inverse_depth;
    EXPECT_NEAR(is.inverse_depth_sigma / is.inverse_depth, relative_sigma, 1e-9 * relative_sigma);
    EXPECT_EQ(is.chain_keyframe, was.chain_keyframe);
    EXPECT_EQ(is.host == was.host, walk.map.keyframes.contains(was.host));
    hosted_elsewhere += is.host != was.host ? 1 : 0;
  }
  EXPECT_GT(hosted_elsewhere, 0);
}

// Told in the order of the culling: the one that carries a keyframe was in the map when that one went, and where it
// went later itself, the chain ends in one that is.
TEST_P(CullingWithin, EveryCulledKeyframeIsCarriedByOneThatStays) {
  Walk walk = walkOf(100);
  std::set<KeyframeId> there = idsOf(walk.map);
  const auto culled = cullKeyframes(options, walk.map, walk.candidates);
  std::map<KeyframeId, CulledKeyframe> by_id;
  for (const CulledKeyframe& each : culled) {
    EXPECT_EQ(there.erase(each.id), 1U) << each.id;
    EXPECT_EQ(there.count(each.kept), 1U) << each.kept;
    by_id[each.id] = each;
  }
  EXPECT_EQ(there, idsOf(walk.map));
  for (KeyframeId id = 0; id < 100; ++id) {
    KeyframeId reference = id;
    Pose reference_T_keyframe;
    while (!walk.map.keyframes.contains(reference)) {
      reference_T_keyframe = by_id.at(reference).kept_T_culled * reference_T_keyframe;
      reference = by_id.at(reference).kept;
    }
    const Pose found = walk.map.keyframes[reference].world_T_camera * reference_T_keyframe;
    const Pose& truth = walk.poses[static_cast<std::size_t>(id)];
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-9) << id;
    EXPECT_LT(rotationAngle(found.rotation, truth.rotation), 1e-7) << id;
  }
}

TEST_P(CullingWithin, CandidatesNameOnlyWhatIsThere) {
  Walk walk = walkOf(100);
  for (PointId id = 1000; id < 1100; ++id) {
    for (KeyframeId view = id % 7; view < 100; view += 1 + id % 31) walk.candidates[id].push_back(view);
  }
  walk.candidates[2000] = {99};
  const Candidates before = walk.candidates;
  cullKeyframes(options, walk.map, walk.candidates);
  for (const auto& [id, views] : before) {
    std::vector<KeyframeId> left;
    for (const KeyframeId view : views) {
      if (walk.map.keyframes.contains(view)) left.push_back(view);
    }
    ASSERT_EQ(walk.candidates.count(id), left.empty() ? 0U : 1U) << id;
    if (!left.empty()) {
      EXPECT_EQ(walk.candidates.at(id), left) << id;
    }
  }
}

TEST_P(CullingWithin, TheSameMapIsCulledTheSameWay) {
  Walk once = walkOf(100), again = walkOf(100);
  const auto first = cullKeyframes(options, once.map, once.candidates);
  const auto second = cullKeyframes(options, again.map, again.candidates);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].id, second[i].id);
    EXPECT_EQ(first[i].kept_T_culled.translation, second[i].kept_T_culled.translation);
  }
  for (const auto& [id, point] : once.map.points) EXPECT_EQ(again.map.points.at(id).inverse_depth, point.inverse_depth);
}

// 12 times round the same loop: what the map takes after the first rounds is what it takes ever after.
TEST_P(CullingWithin, ALongWalkStaysWithinBoundsAndFlat) {
  Walk walk(4, 160);
  std::size_t most_early = 0, most_late = 0, bytes_early = 0, bytes_late = 0;
  for (int i = 0; i < 500; ++i) {
    walk.step();
    cullKeyframes(options, walk.map, walk.candidates);
    ASSERT_LE(static_cast<int>(walk.map.keyframes.size()), options.most_keyframes);
    ASSERT_LE(megabytes(walk.map), options.most_megabytes);
    std::size_t& most = i < 200 ? most_early : most_late;
    std::size_t& bytes = i < 200 ? bytes_early : bytes_late;
    most = std::max(most, walk.map.keyframes.size());
    bytes = std::max(bytes, memoryOf(walk.map));
    if (i % 50 == 49) {
      ASSERT_EQ(mapProblem(Walk::camera(), walk.map), "") << i;
    }
  }
  EXPECT_LE(most_late, most_early + most_early / 10);
  EXPECT_LE(bytes_late, bytes_early + bytes_early / 10);
  EXPECT_GT(walk.map.points.size(), 20U);
}

TEST(Culling, AKeyframeGoesWhoseSightsOthersHaveAndStaysWhereItIsOneOfFew) {
  Walk walk = standing(30);
  CullingOptions options;
  options.recent_keyframes = 3;
  // Keyframe 7 sees a fifth of its points together with keyframe 8 alone.
  std::set<PointId> rare, common;
  for (auto& [id, point] : walk.map.points) {
    if (viewersOf(point).size() == 30) common.insert(id);
    if (id % 5 != 0) continue;
    rare.insert(id);
    seenOnlyBy(7, 8, point, walk);
  }
  ASSERT_GT(rare.size(), 5U);
  ASSERT_EQ(mapProblem(Walk::camera(), walk.map), "");
  const std::size_t points = walk.map.points.size();
  const auto culled = cullKeyframes(options, walk.map, walk.candidates);
  EXPECT_GT(culled.size(), 10U);
  EXPECT_TRUE(walk.map.keyframes.contains(7));
  EXPECT_TRUE(walk.map.keyframes.contains(8));
  EXPECT_EQ(walk.map.points.size(), points);
  for (const PointId id : common) {
    const std::size_t least = rare.count(id) == 0 ? 10 : 2;
    EXPECT_GE(viewersOf(walk.map.points.at(id)).size(), least) << id;
  }
  EXPECT_TRUE(cullKeyframes(options, walk.map, walk.candidates).empty()) << "what is left is needed";
}

TEST(Culling, OverTheBoundsTheOlderOfEqualsStays) {
  Walk walk = standing(20);
  CullingOptions options = withBounds(9, 1000);
  options.other_views = 100;  // nothing is redundant
  cullKeyframes(options, walk.map, walk.candidates);
  EXPECT_EQ(idsOf(walk.map), (std::set<KeyframeId>{0, 1, 2, 3, 15, 16, 17, 18, 19}));
}

TEST(Culling, OverTheBoundsTheLeastNeededGoes) {
  Walk walk = standing(20);
  for (auto& [id, point] : walk.map.points) {
    if (id % 5 == 0) seenOnlyBy(12, 13, point, walk);
  }
  CullingOptions options = withBounds(9, 1000);
  options.other_views = 100;
  cullKeyframes(options, walk.map, walk.candidates);
  EXPECT_EQ(idsOf(walk.map), (std::set<KeyframeId>{0, 1, 12, 13, 15, 16, 17, 18, 19}));
}

TEST(Culling, BoundsThatTheRecentKeyframesBreakLeaveThoseAlone) {
  Walk walk = walkOf(30);
  CullingOptions options = withBounds(3, 0.1);
  options.recent_keyframes = 10;
  cullKeyframes(options, walk.map, walk.candidates);
  EXPECT_EQ(idsOf(walk.map), (std::set<KeyframeId>{0, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29}));
  EXPECT_EQ(mapProblem(Walk::camera(), walk.map), "");
  Walk small = walkOf(1);
  EXPECT_TRUE(cullKeyframes(options, small.map, small.candidates).empty());
}

// A line stays where it is while any keyframe sees it, and goes with the last one.
TEST(Culling, LinesStayWhileTheyAreSeen) {
  Walk walk = standing(20);
  CullingOptions options = withBounds(9, 1000);  // of which 0 to 3 and 15 to 19 stay
  options.other_views = 100;
  addSeenLine(Walk::camera(), 0, {8, 9, 16}, walk.map);
  addSeenLine(Walk::camera(), 1, {10, 11}, walk.map);
  ASSERT_EQ(mapProblem(Walk::camera(), walk.map), "");
  const SpaceLine was = inWorld(walk.map, walk.map.lines.at(0));
  cullKeyframes(options, walk.map, walk.candidates);
  EXPECT_EQ(mapProblem(Walk::camera(), walk.map), "");
  ASSERT_EQ(walk.map.lines.size(), 1U);
  const MapLine& line = walk.map.lines.at(0);
  EXPECT_EQ(line.host, 16);
  EXPECT_EQ(line.seen_in, std::vector<KeyframeId>{16});
  const SpaceLine is = inWorld(walk.map, line);
  EXPECT_LT((is.point - was.point).norm(), 1e-9);
  EXPECT_LT((is.direction - was.direction).norm(), 1e-9);
}

TEST(Culling, SwitchedOffItDoesNothing) {
  Walk walk = walkOf(60);
  CullingOptions options = withBounds(6, 1);
  options.enabled = false;
  const std::size_t bytes = memoryOf(walk.map);
  EXPECT_TRUE(cullKeyframes(options, walk.map, walk.candidates).empty());
  EXPECT_EQ(walk.map.keyframes.size(), 60U);
  EXPECT_EQ(memoryOf(walk.map), bytes);
}

TEST(Culling, MemoryCountsImagesAndPoints) {
  Walk walk = walkOf(10);
  const std::size_t with_images = memoryOf(walk.map);
  EXPECT_GT(with_images, 10U * 640 * 480);
  for (Keyframe& keyframe : walk.map.keyframes) keyframe.images = nullptr;
  EXPECT_EQ(memoryOf(walk.map), with_images - 10U * 640 * 480);
  walk.map.points.clear();
  EXPECT_LT(memoryOf(walk.map), with_images - 10U * 640 * 480);
}

}  // namespace
}  // namespace edgeslam::test
