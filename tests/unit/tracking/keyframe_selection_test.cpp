// P8 to P12: each criterion makes a keyframe by itself.
#include "tracking/keyframe_selection.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace edgeslam {
namespace {

constexpr int width = 640;

// Nothing calls for a keyframe.
KeyframeEvidence calm() {
  KeyframeEvidence evidence;
  evidence.rotation_deg = 5;
  evidence.mean_displacement_px = 40;
  evidence.tracks = 500;
  evidence.average_tracks = 520;
  evidence.mapped = 400;
  evidence.mapped_at_keyframe = 450;
  evidence.seconds = 0.25;
  return evidence;
}

struct Criterion {
  std::string reason;
  KeyframeChoice choice = KeyframeChoice::none;
  std::function<void(KeyframeEvidence&)> just_short, met;
};

// In the order in which they are looked at.
std::vector<Criterion> criteria() {
  using E = KeyframeEvidence;
  return {
      {"rotation", KeyframeChoice::current_frame, [](E& e) { e.rotation_deg = 14.9; },
       [](E& e) { e.rotation_deg = 15.1; }},
      {"few tracks", KeyframeChoice::previous_frame, [](E& e) { e.tracks = 313; }, [](E& e) { e.tracks = 311; }},
      {"few map points", KeyframeChoice::previous_frame, [](E& e) { e.mapped = 250; }, [](E& e) { e.mapped = 249; }},
      {"displacement", KeyframeChoice::current_frame, [](E& e) { e.mean_displacement_px = 127.9; },
       [](E& e) { e.mean_displacement_px = 128.1; }},
      {"interval", KeyframeChoice::current_frame, [](E& e) { e.seconds = 0.49; }, [](E& e) { e.seconds = 0.5; }}};
}

TEST(KeyframeSelection, NothingHappensWhileNoCriterionIsMet) {
  EXPECT_EQ(selectKeyframe(calm(), width, KeyframeOptions()).choice, KeyframeChoice::none);
}

TEST(KeyframeSelection, EachCriterionByItself) {
  for (const Criterion& criterion : criteria()) {
    KeyframeEvidence evidence = calm();
    if (criterion.reason == "few map points") evidence.mapped_at_keyframe = 450;  // 60 % of it are over 250
    criterion.just_short(evidence);
    EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none) << criterion.reason;
    criterion.met(evidence);
    const KeyframeDecision decision = selectKeyframe(evidence, width, KeyframeOptions());
    EXPECT_EQ(decision.choice, criterion.choice) << criterion.reason;
    EXPECT_EQ(decision.reason, criterion.reason);
  }
}

TEST(KeyframeSelection, InFrontOfBareWallsASmallerRotationIsEnough) {
  for (const int on_straight_edges : {125, 126}) {
    KeyframeEvidence evidence = calm();
    evidence.on_straight_edges = on_straight_edges;
    evidence.mapped = 249;
    evidence.mapped_at_keyframe = 260;
    evidence.rotation_deg = 6.9;
    EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none);
    evidence.rotation_deg = 7.1;
    const KeyframeDecision decision = selectKeyframe(evidence, width, KeyframeOptions());
    EXPECT_EQ(decision.choice, on_straight_edges > 125 ? KeyframeChoice::current_frame : KeyframeChoice::none);
    evidence.mapped = 250;
    EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none);
  }
  // A smaller angle asked for everywhere holds here, too.
  KeyframeOptions options;
  options.rotation_deg = 4;
  KeyframeEvidence evidence = calm();
  evidence.on_straight_edges = 400;
  evidence.mapped = 249;
  EXPECT_EQ(selectKeyframe(evidence, width, options).choice, KeyframeChoice::current_frame);
}

TEST(KeyframeSelection, ACameraThatStandsStillMakesNoneHoweverLong) {
  KeyframeEvidence evidence = calm();
  evidence.seconds = 600;
  evidence.mean_displacement_px = 3.1;
  EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none);
  evidence.mean_displacement_px = 3.3;
  EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::current_frame);
}

TEST(KeyframeSelection, TheEarlierCriterionGoesFirst) {
  KeyframeEvidence evidence = calm();
  std::vector<Criterion> all = criteria();
  for (auto criterion = all.rbegin(); criterion != all.rend(); ++criterion) {
    criterion->met(evidence);  // and all later ones are met as well
    EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).reason, criterion->reason);
  }
}

TEST(KeyframeSelection, NoTwoKeyframesFollowEachOtherAtOnce) {
  for (const Criterion& criterion : criteria()) {
    KeyframeEvidence evidence = calm();
    criterion.met(evidence);
    evidence.too_soon = true;
    EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none) << criterion.reason;
    evidence.too_soon = false;
    EXPECT_NE(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none) << criterion.reason;
  }
}

// The paper asks for 250 points; a bare scene has fewer in all.
TEST(KeyframeSelection, StaysCalmOnABareSceneUntilAShareOfItsPointsIsGone) {
  KeyframeEvidence evidence = calm();
  evidence.tracks = 210;
  evidence.average_tracks = 215;
  evidence.mapped_at_keyframe = 200;
  for (const int mapped : {200, 150, 120}) {
    evidence.mapped = mapped;
    EXPECT_EQ(selectKeyframe(evidence, width, KeyframeOptions()).choice, KeyframeChoice::none) << mapped;
  }
  evidence.mapped = 119;
  EXPECT_STREQ(selectKeyframe(evidence, width, KeyframeOptions()).reason, "few map points");
}

TEST(KeyframeSelection, DisplacementIsAShareOfTheImage) {
  KeyframeEvidence evidence = calm();
  evidence.mean_displacement_px = 100;
  EXPECT_EQ(selectKeyframe(evidence, 640, KeyframeOptions()).choice, KeyframeChoice::none);
  EXPECT_STREQ(selectKeyframe(evidence, 480, KeyframeOptions()).reason, "displacement");
}

}  // namespace
}  // namespace edgeslam
