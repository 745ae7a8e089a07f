// Track loss and what follows, through tracking, mapping and places together, on simulated recordings.
#include <gtest/gtest.h>

#include <algorithm>

#include "evaluation/evaluation.h"
#include "pipeline/lockstep_run.h"
#include "simulator/simulator.h"

namespace edgeslam {
namespace {

constexpr int covered_from = 90, covered_for = 24, found_again_frames = 170;

struct CoveredRun {
  RunResult result;
  Trajectory estimate, truth;
};

CoveredRun makeRun() {
  SimulationOptions options;
  options.scene = SceneKind::panels_textured;
  options.frames = found_again_frames;
  options.width = 320;
  options.height = 240;
  options.covered = {{covered_from, covered_for}};
  const SimulatedSequence sequence = makeSequence(options);
  LockstepRun lockstep(sequence.camera, Settings(), found_again_frames, 0);
  CoveredRun run;
  for (int i = 0; i < found_again_frames; ++i) {
    const SimulatedFrame frame = sequence.frame(i);
    lockstep.process(i, frame.time_ns, frame.grey);
    run.truth.push_back({frame.time_ns, frame.world_T_camera});
  }
  run.result = lockstep.finish();
  for (const FrameRecord& frame : run.result.frames) {
    if (frame.has_final_pose) run.estimate.push_back({frame.time_ns, frame.final_world_T_camera});
  }
  return run;
}

const CoveredRun& runWithCoveredLens() {
  static const CoveredRun run = makeRun();
  return run;
}

TEST(FoundAgain, AfterACoveredLensPosesGoOnInTheSameWorld) {
  const CoveredRun& run = runWithCoveredLens();
  int covered_good = 0, after_good = 0;
  for (const FrameRecord& frame : run.result.frames) {
    if (frame.index >= covered_from + 1 && frame.index < covered_from + covered_for)
      covered_good += isGoodPose(frame.state);
    if (frame.index >= covered_from + covered_for + 10) after_good += isGoodPose(frame.state);
  }
  EXPECT_EQ(covered_good, 0) << "a covered lens sees nothing";
  const int after = found_again_frames - covered_from - covered_for - 10;
  EXPECT_GE(after_good, after * 9 / 10);
  const AbsoluteError error = absoluteError(run.estimate, run.truth, Alignment::similarity);
  EXPECT_LT(error.translation.max, 0.05) << "one world before and after [m]";
}

// The answer comes view_delay_frames later: the frame that was asked for has no pose at the time, but a final one, and
// the next frame tracked tells how it was found.
TEST(FoundAgain, TheFrameThatWasFoundHasAFinalPoseAndTheNextOneTellsHow) {
  const CoveredRun& run = runWithCoveredLens();
  const RunResult& result = run.result;
  ASSERT_GE(result.recoveries + result.relocalisations, 1);
  int told = 0;
  for (const FrameRecord& frame : result.frames) {
    if (frame.state != TrackingState::recovered && frame.state != TrackingState::relocalised) continue;
    ++told;
    const FrameRecord& found = result.frames.at(static_cast<std::size_t>(frame.index - Settings().view_delay_frames));
    EXPECT_FALSE(found.has_pose) << found.index;
    EXPECT_TRUE(found.has_final_pose);
    EXPECT_TRUE(std::any_of(result.events.begin(), result.events.end(), [&](const std::string& event) {
      return event.rfind("frame " + std::to_string(found.index) + ": " + stateName(frame.state), 0) == 0;
    })) << found.index;
    EXPECT_FALSE(result.frames.at(static_cast<std::size_t>(frame.index - 1)).has_pose);
    EXPECT_EQ(result.frames.at(static_cast<std::size_t>(frame.index + 1)).state, TrackingState::tracking);
  }
  EXPECT_GE(told, 1);
}

TEST(FoundAgain, EveryPoseCalledGoodHasItsCovariance) {
  const CoveredRun& run = runWithCoveredLens();
  int good = 0;
  for (const FrameRecord& frame : run.result.frames) {
    if (!isGoodPose(frame.state)) continue;
    ++good;
    EXPECT_TRUE(frame.has_pose);
    for (int i = 0; i < 6; ++i) EXPECT_GT(standardDeviation(frame)[i], 0) << frame.index;
  }
  EXPECT_GT(good, 0);
}

}  // namespace
}  // namespace edgeslam
