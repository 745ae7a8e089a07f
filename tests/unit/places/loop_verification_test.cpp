// P26: the same place is accepted, and doubts refuse.
#include "places/loop_verification.h"

#include <gtest/gtest.h>

#include "unit/map/change_each.h"
#include "unit/places/made_place.h"

namespace edgeslam {
namespace {

// A turn of 360 degrees and four keyframes more, from another viewpoint; the drift of its end is known.
class LoopVerificationTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    truth = new std::vector<Pose>(test::turnAround(test::keyframes_a_turn, 4));
    place = new Map(test::makePlace(7, test::placeCamera(), *truth));
  }
  static void TearDownTestSuite() {
    delete place;
    delete truth;
  }
  static std::vector<Pose>* truth;
  static Map* place;
  const Camera camera = test::placeCamera();
};

std::vector<Pose>* LoopVerificationTest::truth = nullptr;
Map* LoopVerificationTest::place = nullptr;

TEST_F(LoopVerificationTest, FindsTheSimilarityOfADriftedReturn) {
  Map map = *place;
  test::addDrift(0.01, 0.002, map);
  const double scale = std::exp(0.01 * (test::keyframes_a_turn + 1));  // of that keyframe against keyframe 1
  const KeyframeId current = test::keyframes_a_turn + 1, candidate = 1;
  const LoopVerification loop = verifyLoop(camera, {}, map, current, candidate, {}, 1);
  ASSERT_TRUE(loop.accepted) << loop.reason;
  EXPECT_GE(loop.inliers, loop.needed_inliers);
  EXPECT_GT(loop.found_share, 0.4);
  const Pose true_motion = (*truth)[current].inverse() * (*truth)[candidate];
  // Camera coordinates shrink as the map's scale grows: a drifted camera sees its own points too large by `scale`.
  EXPECT_NEAR(loop.current_S_candidate.scale, 1.0 * scale / std::exp(0.01), 0.05);
  EXPECT_LT(rotationAngle(loop.current_S_candidate.rotation, true_motion.rotation), 0.012);
  EXPECT_LT((loop.current_S_candidate.translation / loop.current_S_candidate.scale - true_motion.translation).norm(),
            0.03);
  for (const auto& found : loop.found) {
    EXPECT_TRUE(map.points.count(found.candidate_point));
    EXPECT_TRUE(found.current_point < 0 || map.points.count(found.current_point));
    EXPECT_TRUE(insideImage(camera, found.measurement.pixel));
  }
}

TEST_F(LoopVerificationTest, OtherWallsAreRefusedWithAReason) {
  for (KeyframeId candidate = 7; candidate < test::keyframes_a_turn - 4; ++candidate) {
    const LoopVerification loop = verifyLoop(camera, {}, *place, test::keyframes_a_turn + 1, candidate, {}, 1);
    EXPECT_FALSE(loop.accepted) << candidate;
    EXPECT_FALSE(loop.reason.empty());
    EXPECT_LT(loop.descriptor_inliers, 15);
  }
}

TEST_F(LoopVerificationTest, AnotherRoomIsRefused) {
  Map map = *place;
  const Map other = test::makePlace(8, camera, {(*truth)[0], (*truth)[1], (*truth)[2]});
  const auto first = static_cast<KeyframeId>(map.keyframes.size());
  for (Keyframe keyframe : other.keyframes) {
    keyframe.id += first;
    test::changeEach(keyframe.observations, [&](PointObservation& observation) { observation.point += 1000000; });
    map.keyframes.push_back(keyframe);
  }
  for (auto [id, point] : other.points) {
    point.id += 1000000;
    point.host += first;
    for (KeyframeId& keyframe : point.seen_in) keyframe += first;
    map.points.emplace(point.id, point);
  }
  EXPECT_FALSE(verifyLoop(camera, {}, map, first + 1, 1, {}, 1).accepted);
}

TEST_F(LoopVerificationTest, KeyframesWithoutImagesAreRefused) {
  Map map = *place;
  map.keyframes[1].images = nullptr;
  EXPECT_FALSE(verifyLoop(camera, {}, map, test::keyframes_a_turn + 1, 1, {}, 1).accepted);
}

TEST_F(LoopVerificationTest, EachDemandOnDescriptorsRefuses) {
  const auto refused = [&](const LoopVerificationOptions& options) {
    return !verifyLoop(camera, {}, *place, test::keyframes_a_turn + 1, 1, options, 1).accepted;
  };
  LoopVerificationOptions only_descriptors;
  only_descriptors.search.witnesses = 0;
  EXPECT_FALSE(refused(only_descriptors));
  LoopVerificationOptions options = only_descriptors;
  options.fewest_descriptor_inliers = 1000;
  EXPECT_TRUE(refused(options));
  options = only_descriptors;
  options.fewest_needed_inliers = options.most_needed_inliers = 1000;
  EXPECT_TRUE(refused(options));
  options = only_descriptors;
  options.least_found_share = 1.01;
  EXPECT_TRUE(refused(options));
  options = only_descriptors;
  options.fewest_cells = 17;
  EXPECT_TRUE(refused(options));
  options = only_descriptors;
  options.largest_scale = 1.00001;
  EXPECT_TRUE(refused(options));
}

TEST_F(LoopVerificationTest, SameSeedSameBits) {
  const LoopVerification a = verifyLoop(camera, {}, *place, test::keyframes_a_turn + 1, 1, {}, 3),
                         b = verifyLoop(camera, {}, *place, test::keyframes_a_turn + 1, 1, {}, 3);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.current_S_candidate.scale, b.current_S_candidate.scale);
  EXPECT_EQ(a.current_S_candidate.translation, b.current_S_candidate.translation);
}

TEST_F(LoopVerificationTest, GuidedMatchesLieWhereTheTruthProjects) {
  const PlaceView from = placeView(camera, *place, 1, 3), to = placeView(camera, *place, test::keyframes_a_turn + 1, 3);
  const Pose motion = (*truth)[test::keyframes_a_turn + 1].inverse() * (*truth)[1];
  const GuidedMatches guided = matchGuided(camera, *place, from, to, test::asSimilarity(motion), 4, {});
  EXPECT_GT(guided.visible, 100);
  EXPECT_LE(guided.visible_in_both, guided.visible);
  EXPECT_GT(static_cast<double>(guided.matches.size()), 0.6 * guided.visible);
  int near = 0;
  for (const GuidedMatch& match : guided.matches) {
    const Eigen::Vector2d truth_pixel =
        project(camera, motion * from.points[static_cast<std::size_t>(match.from)].position);
    if (std::abs(match.measurement.normal.dot(match.measurement.pixel - truth_pixel)) < 0.7) ++near;
  }
  EXPECT_GT(near, 0.9 * static_cast<double>(guided.matches.size()));
}

TEST_F(LoopVerificationTest, PlaceViewJoinsNeighboursWithoutRepeats) {
  const PlaceView alone = placeView(camera, *place, 5, 0), joined = placeView(camera, *place, 5, 4);
  EXPECT_GT(joined.points.size(), alone.points.size());
  std::vector<PointId> ids;
  for (const PlacePoint& point : joined.points) {
    ids.push_back(point.id);
    EXPECT_TRUE(insideImage(camera, point.measurement.pixel));
    EXPECT_EQ(point.observed, findObservation(place->keyframes[5], point.id) != nullptr);
    EXPECT_LT((project(camera, point.position) - point.measurement.pixel).norm(), 1e-6);
  }
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
}

}  // namespace
}  // namespace edgeslam
