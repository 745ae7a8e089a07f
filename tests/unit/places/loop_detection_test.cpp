// P24, P25: the bar for a loop, and three consecutive keyframes over it.
#include "places/loop_detection.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

// Keyframes without points; those numbered below `turned_before` look `turn` [rad] another way than the others.
Map keyframesOnly(int count, int turned_before = 0, double turn = 0) {
  Map map;
  for (int k = 0; k < count; ++k) {
    Keyframe keyframe;
    keyframe.id = k;
    if (k < turned_before) keyframe.world_T_camera.rotation = rotationExp({0, turn, 0});
    map.keyframes.push_back(keyframe);
  }
  return map;
}

std::vector<int> numbers(const LoopDetection& detection) {
  std::vector<int> keyframes;
  for (const LoopCandidate& candidate : detection.candidates) keyframes.push_back(candidate.keyframe);
  return keyframes;
}

void share(Map& map, KeyframeId a, KeyframeId b) {
  PointObservation observation;
  observation.point = static_cast<PointId>(map.points.size());
  map.keyframes[a].observations.push_back(observation);
  map.keyframes[b].observations.push_back(observation);
  MapPoint point;
  point.id = observation.point;
  point.host = a;
  point.seen_in = {b};
  map.points.emplace(point.id, point);
}

// 30 keyframes, all unlike the current one but the last five before it.
std::vector<double> usualScores() {
  std::vector<double> scores(30, 0.2);
  for (std::size_t k = 25; k < 30; ++k) scores[k] = 0.5 + 0.05 * static_cast<double>(k - 25);
  return scores;
}

TEST(LoopDetection, BarIsTheLowestOfTheLastFive) {
  const Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  EXPECT_DOUBLE_EQ(detectLoops(map, 30, scores, {}).bar, 0.5);
  scores[27] = 0.41;
  EXPECT_DOUBLE_EQ(detectLoops(map, 30, scores, {}).bar, 0.41);
  scores[27] = no_score;  // passed over: one more further back counts
  EXPECT_DOUBLE_EQ(detectLoops(map, 30, scores, {}).bar, 0.2);
}

TEST(LoopDetection, BarLeavesOutKeyframesThatLookAnotherWay) {
  for (const double degrees : {29.0, 31.0}) {
    const Map map = keyframesOnly(31, 28, degrees * M_PI / 180);
    EXPECT_DOUBLE_EQ(detectLoops(map, 30, usualScores(), {}).bar, degrees < 30 ? 0.5 : 0.65);
  }
}

TEST(LoopDetection, NothingToCompareWithGivesNoCandidate) {
  const Map map = keyframesOnly(31, 30, 2);
  const LoopDetection detection = detectLoops(map, 30, std::vector<double>(30, 0.99), {});
  EXPECT_DOUBLE_EQ(detection.bar, 1);
  EXPECT_TRUE(detection.candidates.empty());
  EXPECT_TRUE(detectLoops(keyframesOnly(1), 0, {}, {}).candidates.empty());
}

TEST(LoopDetection, ThreeInARowGiveTheBest) {
  const Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  scores[6] = 0.6;
  scores[7] = 0.8;
  EXPECT_TRUE(detectLoops(map, 30, scores, {}).candidates.empty());  // two
  scores[8] = 0.7;
  EXPECT_EQ(numbers(detectLoops(map, 30, scores, {})), std::vector<int>{7});
  scores[7] = 0.5;  // at the bar is not over it
  EXPECT_TRUE(detectLoops(map, 30, scores, {}).candidates.empty());
}

TEST(LoopDetection, KeyframesWithoutScoreDoNotBreakARow) {
  const Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  scores[5] = 0.6;
  scores[6] = no_score;
  scores[7] = 0.9;
  scores[8] = 0.7;
  EXPECT_EQ(numbers(detectLoops(map, 30, scores, {})), std::vector<int>{7});
}

TEST(LoopDetection, KeyframesThatShareAPointAreNoCandidates) {
  Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  for (const std::size_t k : {6u, 7u, 8u}) scores[k] = 0.8;
  ASSERT_EQ(detectLoops(map, 30, scores, {}).candidates.size(), 1u);
  share(map, 7, 30);
  EXPECT_TRUE(detectLoops(map, 30, scores, {}).candidates.empty());
}

// Map reuse finds some of an old place's points before the loop is closed.
TEST(LoopDetection, AFewPointsMetAgainDoNotHideALoop) {
  Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  for (const std::size_t k : {6u, 7u, 8u}) scores[k] = 0.8;
  for (int i = 0; i < 40; ++i) share(map, 29, 30);
  for (int i = 0; i < 5; ++i) share(map, 6, 30);
  EXPECT_EQ(detectLoops(map, 30, scores, {}).candidates.size(), 1u);
  Map held = map;
  for (int i = 0; i < 2; ++i) share(held, 6, 30);
  EXPECT_TRUE(detectLoops(held, 30, scores, {}).candidates.empty());
  Map never_left = map;
  for (KeyframeId k = 9; k < 29; ++k) share(never_left, k, 30);
  EXPECT_TRUE(detectLoops(never_left, 30, scores, {}).candidates.empty());
}

TEST(LoopDetection, RecentKeyframesAreNoCandidates) {
  const Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  for (const std::size_t k : {20u, 21u, 22u}) scores[k] = 0.8;
  EXPECT_TRUE(detectLoops(map, 30, scores, {}).candidates.empty());
  LoopDetectionOptions options;
  options.recent_keyframes = 7;
  EXPECT_EQ(detectLoops(map, 30, scores, options).candidates.size(), 1u);
}

TEST(LoopDetection, TheBestFewComeBestFirst) {
  const Map map = keyframesOnly(31);
  std::vector<double> scores = usualScores();
  const std::vector<std::pair<std::size_t, double>> peaks{{1, 0.7}, {5, 0.9}, {9, 0.6}, {13, 0.8}};
  for (const auto& [peak, score] : peaks) {
    scores[peak - 1] = scores[peak + 1] = 0.55;
    scores[peak] = score;
  }
  EXPECT_EQ(numbers(detectLoops(map, 30, scores, {})), (std::vector<int>{5, 13, 1}));
}

}  // namespace
}  // namespace edgeslam
