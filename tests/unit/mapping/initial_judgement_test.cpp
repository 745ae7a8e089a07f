// P13 and P15: what a start of the map asks for, one by one.
#include "mapping/initial_judgement.h"

#include <gtest/gtest.h>

#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const test::EdgeScene judged_wall = test::framesOnAWall(4);

InitialEvidence enough() {
  InitialEvidence evidence;
  evidence.followed = 200;
  evidence.points = 150;
  evidence.parallax_deg = 2;
  evidence.quality.pieces = 100;
  evidence.quality.kept = 90;
  return evidence;
}

TEST(InitialJudgement, ARotationAloneMovesNothing) {
  const InitialFrames turned =
      test::initialFrames(test::distorted_camera, judged_wall, {Pose(), {rotationExp({0, 0.1, 0}), {0, 0, 0}}});
  EXPECT_LT(displacementLessRotation(test::distorted_camera, turned), 0.1);
  const InitialFrames moved = test::initialFrames(test::distorted_camera, judged_wall, {Pose(), test::at(0.3, 0.1)});
  EXPECT_GT(displacementLessRotation(test::distorted_camera, moved), 3);
  InitialFrames nothing_seen = moved;
  nothing_seen.since.back().observations.clear();
  EXPECT_EQ(displacementLessRotation(test::distorted_camera, nothing_seen), 0);
}

TEST(InitialJudgement, OnlyTheFirstMapOfASmallImageWithCornersBeginsWithLess) {
  const InitialisationOptions options;
  InitialFrames frames = test::initialFrames(test::distorted_camera, judged_wall, {Pose(), test::at(0.3)});
  frames.first.keyframe = 0;
  Camera small = test::distorted_camera;
  small.fx = small.fy = 200;
  EXPECT_NEAR(leastDisplacement(small, frames, options), 200 * 0.00716, 0.01);
  Camera large = small;
  large.fx = large.fy = 500;
  EXPECT_EQ(leastDisplacement(large, frames, options), options.least_displacement_px);
  InitialFrames beside_another = frames;
  beside_another.first.keyframe = 7;
  EXPECT_EQ(leastDisplacement(small, beside_another, options), options.least_displacement_px);
  for (PointObservation& observation : frames.since.back().observations) observation.corner = false;
  EXPECT_EQ(leastDisplacement(small, frames, options), options.least_displacement_px);
}

TEST(InitialJudgement, TheTruthHasItsParallaxAndItsQuality) {
  const Pose pose = test::at(0.3);
  const InitialFrames frames = test::initialFrames(test::distorted_camera, judged_wall, {Pose(), pose});
  const InitialEvidence evidence =
      judgeInitialStructure(frames, test::trueStructure(judged_wall, frames, {0}, {pose}), InitialisationOptions());
  EXPECT_GT(evidence.followed, 300);
  EXPECT_EQ(evidence.points, evidence.followed);
  EXPECT_NEAR(evidence.parallax_deg, 5, 1.5);  // 0.3 seen from a distance of about 3
  EXPECT_GT(evidence.quality.share(), 0.6);
  InitialisationOptions of_two_frames;
  of_two_frames.attempt_interval = 1;
  EXPECT_EQ(reasonToWait(evidence, of_two_frames), "");
}

TEST(InitialJudgement, AnEarlyStartNeedsMoreThatSpeaksForIt) {
  InitialEvidence evidence;
  evidence.parallax_deg = 5;
  evidence.followed = evidence.points = 400;
  evidence.quality.pieces = 100;
  evidence.quality.kept = 70;
  const InitialisationOptions options;
  evidence.frames = options.attempt_interval;
  EXPECT_EQ(reasonToWait(evidence, options), "");
  evidence.frames = options.attempt_interval - 1;
  EXPECT_EQ(reasonToWait(evidence, options), "quality too low (70 of 100 edge pieces hold)");
  evidence.quality.kept = 80;
  EXPECT_EQ(reasonToWait(evidence, options), "");
  evidence.followed = evidence.points = 50;
  EXPECT_EQ(reasonToWait(evidence, options), "too few points with a good depth (50)");
}

TEST(InitialJudgement, PointsOfUncertainDepthDoNotCount) {
  const Pose pose = test::at(0.3);
  const InitialFrames frames = test::initialFrames(test::distorted_camera, judged_wall, {Pose(), pose});
  InitialStructure structure = test::trueStructure(judged_wall, frames, {0}, {pose});
  for (double& sigma : structure.depth_sigmas) sigma *= 10;
  const InitialEvidence evidence = judgeInitialStructure(frames, structure, InitialisationOptions());
  EXPECT_GT(evidence.followed, 300);
  EXPECT_EQ(evidence.points, 0);
  EXPECT_EQ(evidence.parallax_deg, 0);
}

TEST(InitialJudgement, EachConditionIsNamed) {
  const InitialisationOptions options;
  EXPECT_EQ(reasonToWait(enough(), options), "");
  InitialEvidence evidence = enough();
  evidence.parallax_deg = 0.994;
  EXPECT_EQ(reasonToWait(evidence, options), "too little parallax (0.99 deg)");
  evidence = enough();
  evidence.points = 79;  // of 200 followed
  EXPECT_EQ(reasonToWait(evidence, options), "too few points with a good depth (79)");
  evidence.points = 80;
  EXPECT_EQ(reasonToWait(evidence, options), "");
  evidence = enough();
  evidence.quality.kept = 59;
  EXPECT_EQ(reasonToWait(evidence, options), "quality too low (59 of 100 edge pieces hold)");
  EXPECT_EQ(inWords(enough()), "quality 90 of 100 edge pieces, parallax 2.00 deg, 150 points");
}

}  // namespace
}  // namespace edgeslam
