// P26 by guided search, in rendered rooms of known truth with bare walls.
#include "places/loop_search.h"

#include <gtest/gtest.h>

#include <utility>

#include "unit/geometry/degree.h"
#include "unit/map/change_each.h"
#include "unit/places/made_place.h"

namespace edgeslam::test {
namespace {

constexpr KeyframeId kCurrent = keyframes_a_turn + 3, kCandidate = 2;

const std::vector<Pose>& trueTurn() {
  static const std::vector<Pose> poses = turnAround(keyframes_a_turn, 5);
  return poses;
}

const Map& bareRoom() {
  static const Map map = makePlace(bare_rooms, placeCamera(), trueTurn());
  return map;
}

// Descriptors never suffice.
LoopVerificationOptions withoutDescriptors() {
  LoopVerificationOptions options;
  options.fewest_descriptor_inliers = 1000;
  return options;
}

LoopVerification verify(const Map& map, KeyframeId current, KeyframeId candidate,
                        const LoopVerificationOptions& options = withoutDescriptors()) {
  return verifyLoop(placeCamera(), {}, map, current, candidate, options, 1);
}

// 7 % of scale and a degree over the turn.
constexpr double log_scale_a_step = 0.07 / (kCurrent - kCandidate);
Map drifted() {
  Map map = bareRoom();
  addDrift(log_scale_a_step, degree / keyframes_a_turn, map);
  return map;
}

TEST(LoopSearch, FindsTheSimilarityOfADriftedReturn) {
  const Map map = drifted();
  const LoopVerification loop = verify(map, kCurrent, kCandidate);
  ASSERT_TRUE(loop.accepted) << loop.reason;
  EXPECT_NE(loop.reason.find("by search"), std::string::npos);
  const Pose motion = trueTurn()[kCurrent].inverse() * trueTurn()[kCandidate];
  EXPECT_NEAR(loop.current_S_candidate.scale, std::exp(0.07), 0.015);
  EXPECT_LT(rotationAngle(loop.current_S_candidate.rotation, motion.rotation), 0.5 * degree);
  EXPECT_LT((upToScale(loop.current_S_candidate).translation - motion.translation).norm(), 0.04);
  EXPECT_EQ(static_cast<int>(loop.found.size()), loop.inliers);
  for (const auto& found : loop.found) {
    const auto point = map.points.find(found.candidate_point);
    ASSERT_NE(point, map.points.end());
    EXPECT_EQ(findObservation(map.keyframes[kCurrent], found.candidate_point), nullptr);
    EXPECT_TRUE(found.current_point < 0 || map.points.count(found.current_point));
  }
}

TEST(LoopSearch, OtherWallsAreRefused) {
  for (KeyframeId candidate = 8; candidate < keyframes_a_turn - 5; ++candidate) {
    const LoopVerification loop = verify(bareRoom(), kCurrent, candidate);
    EXPECT_FALSE(loop.accepted) << candidate << ": " << loop.reason;
    EXPECT_FALSE(loop.reason.empty());
  }
}

// The map of one room, then that of another of the same shape: the same corners of walls, other tiles.
TEST(LoopSearch, ARoomThatLooksAlikeIsRefused) {
  Map map = bareRoom();
  const std::vector<Pose> poses(trueTurn().begin(), trueTurn().begin() + 8);
  const Map other = makePlace(bare_rooms + 1, placeCamera(), poses);
  const auto first = static_cast<KeyframeId>(map.keyframes.size());
  constexpr PointId offset = 1000000;
  for (Keyframe keyframe : other.keyframes) {
    keyframe.id += first;
    test::changeEach(keyframe.observations, [&](PointObservation& observation) { observation.point += offset; });
    map.keyframes.push_back(keyframe);
  }
  for (auto [id, point] : other.points) {
    point.id += offset;
    point.host += first;
    for (KeyframeId& keyframe : point.seen_in) keyframe += first;
    map.points.emplace(point.id, point);
  }
  for (const KeyframeId k : {4, 5, 6, 7}) {
    EXPECT_FALSE(verify(map, first + k, k, {}).accepted);
    EXPECT_FALSE(verify(map, first + k, k).accepted);
  }
}

TEST(LoopSearch, EachDemandRefuses) {
  const Map map = drifted();
  const auto refused = [&](const auto& ask) {
    LoopVerificationOptions options = withoutDescriptors();
    ask(options.search);
    return !verify(map, kCurrent, kCandidate, options).accepted;
  };
  EXPECT_FALSE(refused([](LoopSearchOptions&) {}));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.search.bare_inlier_share = 1.01; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.found_and_explained = 2; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.fewest_pairs = 1000; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.agreeing_share = 1.01; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.scale_deviation = 1e-4; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.fewest_witnesses = o.witnesses + 1; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.witness_distance = 1e-6; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.witness_turn_deg = 1e-6; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.witness_scale = 1e-6; }));
  EXPECT_TRUE(refused([](LoopSearchOptions& o) { o.search.explained_share = 1.01; }));
}

TEST(LoopSearch, AChangeOfScaleBeyondTheBoundIsRefusedEitherWay) {
  for (const double log_scale : {log_scale_a_step, -log_scale_a_step}) {
    Map map = bareRoom();
    addDrift(log_scale, 0, map);
    LoopVerificationOptions options = withoutDescriptors();
    options.largest_scale = 1.1;
    EXPECT_TRUE(verify(map, kCurrent, kCandidate, options).accepted) << log_scale;
    options.largest_scale = 1.04;
    const LoopVerification loop = verify(map, kCurrent, kCandidate, options);
    EXPECT_FALSE(loop.accepted) << log_scale;
    EXPECT_NE(loop.reason.find("a change of scale by"), std::string::npos) << loop.reason;
  }
}

TEST(LoopSearch, TakesThePoseThatShowsMostOfTheOldSide) {
  const Map map = drifted();
  int more = 0;
  for (const auto& pair : {std::pair{keyframes_a_turn + 1, 1}, {keyframes_a_turn + 2, 2}, {kCurrent, kCandidate}}) {
    const int current = pair.first, candidate = pair.second;
    const auto found_share = [&](int refined_poses) {
      LoopVerificationOptions options = withoutDescriptors();
      options.search.refined_poses = refined_poses;
      const LoopVerification loop = verify(map, current, candidate, options);
      EXPECT_TRUE(loop.accepted) << current << ": " << loop.reason;
      return loop.found_share;
    };
    const double of_first = found_share(1), of_many = found_share(6);
    EXPECT_GE(of_many, of_first) << current;
    more += of_many > of_first;
  }
  EXPECT_GE(more, 1) << "no start but the first led anywhere else";
}

TEST(LoopSearch, SameInputSameBits) {
  const LoopVerification a = verify(bareRoom(), kCurrent, kCandidate), b = verify(bareRoom(), kCurrent, kCandidate);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.current_S_candidate.scale, b.current_S_candidate.scale);
  EXPECT_EQ(a.current_S_candidate.translation, b.current_S_candidate.translation);
}

TEST(EstimateScale, OutliersDoNotMoveIt) {
  ScalePairs pairs;
  for (int i = 0; i < 90; ++i) {
    pairs.deviations.push_back(0.05);
    pairs.log_ratios.push_back(i % 3 == 2 ? 0.9 + 0.01 * i : 0.07 + 0.04 * std::sin(i));
  }
  const ScaleEstimate estimate = estimateScale(pairs);
  EXPECT_NEAR(estimate.log_scale, 0.07, 0.01);
  EXPECT_NEAR(estimate.agreeing_share, 2.0 / 3, 0.01);
  EXPECT_NEAR(estimate.deviation, 0.05 / std::sqrt(60.0), 0.002);
}

TEST(EstimateScale, ScatterBeyondTheDeviationsWidensIt) {
  ScalePairs pairs;
  for (int i = 0; i < 100; ++i) {
    pairs.deviations.push_back(0.05);
    pairs.log_ratios.push_back(0.1 * (i % 3 - 1));
  }
  EXPECT_GT(estimateScale(pairs).deviation, 1.5 * 0.05 / 10);
}

TEST(EstimateScale, NoPairsTellNothing) {
  const ScaleEstimate estimate = estimateScale({});
  EXPECT_EQ(estimate.agreeing_share, 0);
  EXPECT_FALSE(estimate.deviation < 1e6);
}

}  // namespace
}  // namespace edgeslam::test
