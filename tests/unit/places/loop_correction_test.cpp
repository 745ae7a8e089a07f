// P27: a verified loop corrects the map and merges its points.
#include "places/loop_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "geometry/angles.h"
#include "mapping/global_adjustment.h"
#include "places/loop_closing.h"
#include "unit/map/change_each.h"
#include "unit/places/made_place.h"

namespace edgeslam {
namespace {

bool sortedAndWhole(const Map& map) {
  for (const Keyframe& keyframe : map.keyframes) {
    for (std::size_t i = 1; i < keyframe.observations.size(); ++i) {
      if (keyframe.observations[i - 1].point >= keyframe.observations[i].point) return false;
    }
  }
  for (const auto& [id, point] : map.points) {
    for (std::size_t i = 0; i < point.seen_in.size(); ++i) {
      if (i > 0 && point.seen_in[i - 1] >= point.seen_in[i]) return false;
      if (point.seen_in[i] == point.host) return false;
      if (!findObservation(map.keyframes[point.seen_in[i]], id)) return false;
    }
  }
  return true;
}

Map firstKeyframes(const Map& map, std::size_t count) {
  Map part;
  for (std::size_t k = 0; k < count; ++k) part.keyframes.push_back(map.keyframes.atPlace(k));
  const KeyframeId latest = part.keyframes.back().id;
  for (auto [id, point] : map.points) {
    if (point.host > latest) continue;
    while (!point.seen_in.empty() && point.seen_in.back() > latest) point.seen_in.pop_back();
    if (!point.seen_in.empty()) part.points.emplace(id, point);
  }
  return part;
}

// A turn of 360 degrees and four keyframes more, drifted.
class LoopCorrectionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    truth = new std::vector<Pose>(test::turnAround(test::keyframes_a_turn, 4));
    place = new Map(test::makePlace(7, test::placeCamera(), *truth));
    test::addDrift(0.006, 0.002, *place);
  }
  static void TearDownTestSuite() {
    delete place;
    delete truth;
  }
  static std::vector<Pose>* truth;
  static Map* place;
  const Camera camera = test::placeCamera();

  LoopCorrection correctionOf(const Map& map) const {
    const KeyframeId current = test::keyframes_a_turn + 1;
    const LoopVerification loop = verifyLoop(camera, {}, map, current, 1, {}, 1);
    EXPECT_TRUE(loop.accepted) << loop.reason;
    LoopCorrection correction;
    EXPECT_TRUE(computeCorrection(camera, map, current, 1, loop, {}, {}, correction));
    return correction;
  }
};

std::vector<Pose>* LoopCorrectionTest::truth = nullptr;
Map* LoopCorrectionTest::place = nullptr;

TEST_F(LoopCorrectionTest, TakesTheDriftAway) {
  Map map = *place;
  const double before = test::positionError(map, *truth);
  applyCorrection(correctionOf(map), map);
  EXPECT_LT(test::positionError(map, *truth), 0.5 * before);
  ASSERT_TRUE(adjustGlobally(camera, {}, {}, map));
  EXPECT_LT(test::positionError(map, *truth), 0.1 * before);
  EXPECT_TRUE(sortedAndWhole(map));
}

// Where y is down.
InertialAlignment knownAlignment() {
  InertialAlignment alignment;
  alignment.is_known = true;
  alignment.gravity = {0, standard_gravity, 0};
  return alignment;
}

TEST_F(LoopCorrectionTest, WhatInertiaKnowsStays) {
  Map map = test::makePlace(7, camera, *truth);
  test::addDrift(0, 0.004, map);
  map.inertia[0] = knownAlignment();
  const double before = test::positionError(map, *truth);
  const LoopCorrection correction = correctionOf(map);
  for (const auto& [keyframe, move] : correction.new_world_S_world) {
    EXPECT_EQ(move.scale, 1);
    EXPECT_LT((move.rotation * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  }
  applyCorrection(correction, map);
  EXPECT_LT(test::positionError(map, *truth), 0.5 * before);
}

TEST_F(LoopCorrectionTest, NoLoopTiltsWhatIsUpright) {
  const auto reasonsOf = [&](const Map& map) {
    LoopClosingOptions options;
    options.detection.recent_keyframes = 8;
    LoopClosing closing(camera, {}, options);
    std::string reasons;
    bool closed = false;
    for (std::size_t count = 1; count <= map.keyframes.size(); ++count) {
      Map then = firstKeyframes(map, count);
      then.inertia = map.inertia;
      const LoopOutcome outcome = closing.addKeyframe(then);
      closed = closed || outcome.correction.has_value();
      for (const JudgedLoop& judged : outcome.considered) reasons += judged.reason + "\n";
    }
    return std::pair(closed, reasons);
  };
  Map map = *place;
  const Similarity tilt{1, rotationExp({radians(9), 0, 0}), Eigen::Vector3d::Zero()};
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.id >= test::keyframes_a_turn / 2) keyframe.world_T_camera = moved(tilt, keyframe.world_T_camera);
  }
  EXPECT_TRUE(reasonsOf(map).first) << reasonsOf(map).second;
  map.inertia[0] = knownAlignment();
  const auto [closed, reasons] = reasonsOf(map);
  EXPECT_FALSE(closed);
  EXPECT_NE(reasons.find("would tilt what is upright by"), std::string::npos) << reasons;
}

TEST_F(LoopCorrectionTest, WorldsThatAreUprightAreJoinedUpright) {
  const KeyframeId current = test::keyframes_a_turn + 1;
  Map map = *place;
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.id >= test::keyframes_a_turn / 2) keyframe.world = 1;
  }
  map.inertia[0] = map.inertia[1] = knownAlignment();
  LoopVerification loop;
  const Pose current_T_candidate =
      keyframeOf(map, current).world_T_camera.inverse() * keyframeOf(map, 1).world_T_camera;
  loop.current_S_candidate = {1.1, current_T_candidate.rotation * rotationExp({0.03, 0.02, 0.01}),
                              current_T_candidate.translation};
  const WorldJoin as_found = joinOf(map, current, 1, loop.current_S_candidate);
  LoopCorrection correction;
  ASSERT_TRUE(computeCorrection(camera, map, current, 1, loop, {}, {}, correction));
  ASSERT_TRUE(correction.join);
  const Similarity& join = correction.join->to_S_from;
  EXPECT_EQ(correction.join->from, 1);
  EXPECT_NEAR(join.scale, 1, 1e-12);
  EXPECT_LT((join.rotation * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  const Eigen::Vector3d here = keyframeOf(map, current).world_T_camera.translation;
  EXPECT_LT((join * here - as_found.to_S_from * here).norm(), 1e-9);
  EXPECT_GT(rotationAngle(as_found.to_S_from.rotation, join.rotation), 0.02);
}

TEST_F(LoopCorrectionTest, PointsStayAttachedToTheirHosts) {
  Map map = *place;
  const LoopCorrection correction = correctionOf(map);
  applyCorrection(correction, map);
  for (const auto& [id, point] : map.points) {
    const MapPoint& before = place->points.at(id);
    const Similarity& move = correction.new_world_S_world.at(point.host);
    EXPECT_LT((worldPosition(map, point) - move * worldPosition(*place, before)).norm(), 1e-9);
    EXPECT_NEAR(point.inverse_depth_sigma / point.inverse_depth, before.inverse_depth_sigma / before.inverse_depth,
                1e-12);
  }
  EXPECT_EQ(map.keyframes[0].world_T_camera.translation, place->keyframes[0].world_T_camera.translation);
}

TEST_F(LoopCorrectionTest, OldPointsAreSeenByTheNewSideOnce) {
  Map map = *place;
  const LoopCorrection correction = correctionOf(map);
  EXPECT_GT(correction.observations.size(), 60u);
  ASSERT_EQ(sharedPoints(map, test::keyframes_a_turn + 1)[1], 0);
  applyCorrection(correction, map);
  EXPECT_GT(sharedPoints(map, test::keyframes_a_turn + 1)[1], 30);
  EXPECT_TRUE(sortedAndWhole(map));

  Map twice = map;
  LoopCorrection still = correction;
  for (auto& [keyframe, move] : still.new_world_S_world) move = {};
  applyCorrection(still, twice);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    EXPECT_EQ(twice.keyframes[k].observations.size(), map.keyframes[k].observations.size());
  }
  EXPECT_TRUE(sortedAndWhole(twice));
}

TEST_F(LoopCorrectionTest, AMapThatWentOnGoesAlong) {
  const Map then = firstKeyframes(*place, test::keyframes_a_turn + 2);
  const LoopCorrection correction = correctionOf(then);
  ASSERT_EQ(correction.new_world_S_world.size(), static_cast<std::size_t>(test::keyframes_a_turn + 2));
  Map now = *place;
  now.points.erase(correction.observations.front().observation.point);
  applyCorrection(correction, now);
  const Similarity& last = correction.new_world_S_world.rbegin()->second;
  for (std::size_t k = test::keyframes_a_turn + 2; k < now.keyframes.size(); ++k) {
    const Eigen::Vector3d moved = last * place->keyframes[k].world_T_camera.translation;
    EXPECT_LT((now.keyframes[k].world_T_camera.translation - moved).norm(), 1e-12);
  }
  EXPECT_TRUE(sortedAndWhole(now));
  Map untouched = now;
  applyCorrection({}, untouched);
  EXPECT_EQ(untouched.keyframes[3].world_T_camera.translation, now.keyframes[3].world_T_camera.translation);
}

TEST_F(LoopCorrectionTest, LoopClosingFindsTheReturnAndNothingBefore) {
  LoopClosingOptions options;
  options.detection.recent_keyframes = 8;
  LoopClosing closing(camera, {}, options);
  bool closed = false;
  for (std::size_t count = 1; count <= place->keyframes.size(); ++count) {
    const Map map = firstKeyframes(*place, count);
    const LoopOutcome outcome = closing.addKeyframe(map);
    EXPECT_EQ(outcome.current, static_cast<KeyframeId>(count) - 1);
    EXPECT_LE(outcome.considered.size(), 3u);
    for (const JudgedLoop& judged : outcome.considered) {
      EXPECT_FALSE(judged.reason.empty());
      if (!judged.accepted) continue;
      const int turned = (outcome.current - judged.keyframe + test::keyframes_a_turn / 2) % test::keyframes_a_turn -
                         test::keyframes_a_turn / 2;  // keyframes
      EXPECT_LT(std::abs(turned), 4);
    }
    if (outcome.correction) {
      EXPECT_GE(count, static_cast<std::size_t>(test::keyframes_a_turn - 3));
      closed = true;
    }
  }
  EXPECT_TRUE(closed);
  // A map begun anew is taken as one.
  EXPECT_FALSE(closing.addKeyframe(firstKeyframes(*place, 1)).correction);
}

TEST_F(LoopCorrectionTest, NoDriftIsThatLarge) {
  LoopClosingOptions options;
  options.detection.recent_keyframes = 8;
  options.largest_drift = 1e-4;
  LoopClosing closing(camera, {}, options);
  bool refused = false;
  for (std::size_t count = 1; count <= place->keyframes.size(); ++count) {
    const LoopOutcome outcome = closing.addKeyframe(firstKeyframes(*place, count));
    EXPECT_FALSE(outcome.correction);
    for (const JudgedLoop& judged : outcome.considered) {
      refused = refused || judged.reason.find("would move the keyframe") != std::string::npos;
    }
  }
  EXPECT_TRUE(refused);
}

TEST_F(LoopCorrectionTest, LoopsThatContradictEachOtherAreRefused) {
  const KeyframeId current = test::keyframes_a_turn + 1;
  const auto loopTo = [&](KeyframeId candidate, const Pose& world_T_current) {
    const Pose current_T_candidate = world_T_current.inverse() * place->keyframes[candidate].world_T_camera;
    JudgedLoop loop;
    loop.keyframe = candidate;
    loop.accepted = true;
    loop.verification.current_S_candidate = test::asSimilarity(current_T_candidate);
    return loop;
  };
  const Pose here = place->keyframes[current].world_T_camera;
  Pose near = here, away = here, turned = here;
  near.translation.x() += 0.1;
  away.translation.x() += 4;
  turned.rotation = here.rotation * rotationExp({0, M_PI / 2, 0});

  std::vector<JudgedLoop> loops{loopTo(1, here), loopTo(3, near)};
  refuseContradictions(*place, current, loops);
  EXPECT_TRUE(loops[0].accepted && loops[1].accepted);
  for (const Pose& other : {away, turned}) {
    loops = {loopTo(1, here), loopTo(7, other)};
    refuseContradictions(*place, current, loops);
    EXPECT_FALSE(loops[0].accepted || loops[1].accepted);
    EXPECT_NE(loops[0].reason.find("keyframe 7"), std::string::npos);
    loops = {loopTo(1, here), loopTo(7, other)};
    loops[1].accepted = false;  // refused by itself: says nothing
    refuseContradictions(*place, current, loops);
    EXPECT_TRUE(loops[0].accepted);
  }
}

const WorldJoin apart{5, 1, {0.4, Eigen::Quaterniond(rotationExp({0.3, 1.1, -0.5})), {3, -2, 7}}};

// No point is seen both before a keyframe and from it on.
void cutBefore(KeyframeId first, Map& map) {
  for (auto& [id, point] : map.points) {
    const bool is_later = point.host >= first;
    std::vector<KeyframeId>& seen_in = point.seen_in;
    seen_in.erase(std::remove_if(seen_in.begin(), seen_in.end(),
                                 [&](KeyframeId keyframe) { return (keyframe >= first) != is_later; }),
                  seen_in.end());
  }
  for (auto point = map.points.begin(); point != map.points.end();) {
    point = point->second.seen_in.empty() ? map.points.erase(point) : std::next(point);
  }
}

// The last keyframes are of a world of their own, with another frame and unit.
constexpr KeyframeId first_of_young = test::keyframes_a_turn - 3;
Map inTwoWorlds(Map map) {
  cutBefore(first_of_young, map);
  for (Keyframe& keyframe : map.keyframes) keyframe.world = keyframe.id >= first_of_young ? apart.from : 0;
  joinWorlds(apart, map);
  return map;
}

TEST_F(LoopCorrectionTest, JoinsTwoWorldsThatAreOne) {
  Map map = inTwoWorlds(*place);
  LoopVerificationOptions of_any_scale;
  of_any_scale.largest_scale = 10;
  const LoopVerification loop = verifyLoop(camera, {}, map, test::keyframes_a_turn + 2, 2, of_any_scale, 1);
  ASSERT_TRUE(loop.accepted || loop.accepted_by_descriptors) << loop.reason;
  LoopCorrection correction;
  ASSERT_TRUE(computeCorrection(camera, map, test::keyframes_a_turn + 2, 2, loop, {}, {}, correction));
  ASSERT_TRUE(correction.join);
  EXPECT_EQ(correction.join->from, 1);
  EXPECT_EQ(correction.join->to, 0);
  EXPECT_NEAR(correction.join->to_S_from.scale, 1 / apart.to_S_from.scale, 0.2 / apart.to_S_from.scale);
  applyCorrection(correction, map);
  EXPECT_EQ(worldsOf(map), std::vector<int>{0});
  EXPECT_LT(test::positionError(map, *truth), 0.3);
  EXPECT_TRUE(sortedAndWhole(map));
}

// Neither descriptors nor the search accept a loop.
LoopClosingOptions nothingSuffices() {
  LoopClosingOptions options;
  options.detection.recent_keyframes = 8;
  options.verification.fewest_descriptor_inliers = 1000;
  options.verification.search.search.bare_inlier_share = 1.01;
  return options;
}

// The loop that joins the worlds, if there is one.
std::optional<LoopOutcome> firstJoin(const Map& map, double noise_factor, const LoopClosingOptions& options) {
  const PointAccuracyOptions presumed;
  Map rough = map;
  for (Keyframe& keyframe : rough.keyframes) {
    test::changeEach(keyframe.observations, [&](PointObservation& seen) {
      seen.measurement.sigma_normal = noise_factor * (seen.corner ? presumed.sigma_corner : presumed.sigma_edge);
    });
  }
  LoopClosing closing(test::placeCamera(), {}, options);
  for (std::size_t count = 1; count <= rough.keyframes.size(); ++count) {
    LoopOutcome outcome = closing.addKeyframe(firstKeyframes(rough, count));
    if (outcome.correction) return outcome;
  }
  return std::nullopt;
}

TEST_F(LoopCorrectionTest, WhatIsNearlyFoundJoinsWorldsWhereOtherKeyframesSayTheSame) {
  const Map map = inTwoWorlds(*place);
  LoopClosingOptions options = nothingSuffices();
  options.agreeing_near_keyframes = 1;
  const std::optional<LoopOutcome> outcome = firstJoin(map, 2, options);
  ASSERT_TRUE(outcome);
  EXPECT_GE(outcome->current, test::keyframes_a_turn - 1);
  const std::optional<WorldJoin>& join = outcome->correction->join;
  ASSERT_TRUE(join);
  EXPECT_NEAR(join->to_S_from.scale, 1 / apart.to_S_from.scale, 0.2 / apart.to_S_from.scale);
  EXPECT_FALSE(outcome->correction->observations.empty());

  EXPECT_FALSE(firstJoin(map, 1, options)) << "where a camera is good, what is right is found";
  options.agreeing_near_keyframes = 20;
  EXPECT_FALSE(firstJoin(map, 2, options)) << "so many keyframes there are not";
}

TEST_F(LoopCorrectionTest, NoJoinTakesTheCameraFartherThanItCanHaveCome) {
  Map map = inTwoWorlds(*place);
  LoopClosingOptions options;
  options.detection.recent_keyframes = 8;
  options.telling_corners = 10'000;
  EXPECT_TRUE(firstJoin(map, 1, options));
  // It was lost on the other side of the circle, and the young world was begun 0.4 s later.
  constexpr KeyframeId lost_at = 12;
  cutBefore(lost_at, map);
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.id >= first_of_young) keyframe.time_ns -= (first_of_young - lost_at) * 400'000'000LL;
    if (keyframe.id >= lost_at && keyframe.id < first_of_young) keyframe.world = 7;
  }
  forgetWorld(map, 7);
  EXPECT_FALSE(firstJoin(map, 1, options));
  options.telling_corners = 1;
  EXPECT_TRUE(firstJoin(map, 1, options)) << "no look-alike has so many corners: time was left out";
}

}  // namespace
}  // namespace edgeslam
