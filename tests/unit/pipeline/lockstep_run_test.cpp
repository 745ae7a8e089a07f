#include "pipeline/lockstep_run.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <set>

#include "map/map_file.h"
#include "simulator/simulator.h"

namespace edgeslam {
namespace {

constexpr int lockstep_frames = 60;

struct Recording {
  SimulatedSequence sequence;
  std::vector<cv::Mat> images;
};

// Enough to start a map and to go on with it.
const Recording& recording() {
  static const Recording made = [] {
    SimulationOptions options;
    options.scene = SceneKind::panels_textured;
    options.frames = lockstep_frames;
    options.width = 320;
    options.height = 240;
    Recording recording{makeSequence(options), {}};
    for (int i = 0; i < lockstep_frames; ++i) recording.images.push_back(recording.sequence.frame(i).grey);
    return recording;
  }();
  return made;
}

// `unreadable`: frames that cannot be read; `live`: the records as they were given out, where asked for.
RunResult run(const Settings& settings, const std::set<int>& unreadable = {}, std::vector<FrameRecord>* live = nullptr,
              int frames = lockstep_frames) {
  const Recording& made = recording();
  LockstepRun lockstep(made.sequence.camera, settings, frames, 4);
  for (int i = 0; i < frames; ++i) {
    const std::int64_t time = made.sequence.time(i);
    const FrameRecord& record = unreadable.count(i) > 0
                                    ? lockstep.skip(i, time, "frame " + std::to_string(i) + " is cut off")
                                    : lockstep.process(i, time, made.images[static_cast<std::size_t>(i)]);
    if (live) live->push_back(record);
  }
  return lockstep.finish();
}

std::int64_t firstTracked(const RunResult& result) {
  for (const FrameRecord& frame : result.frames) {
    if (frame.state == TrackingState::tracking) return frame.index;
  }
  return -1;
}

// The frame at which the map came to stand: the last one that it was started from.
std::int64_t mapMadeAt(const RunResult& result) {
  std::int64_t last = -1;
  for (const KeyframeRecord& keyframe : result.keyframes) {
    if (keyframe.reason == "initialisation") last = std::max(last, keyframe.frame_index);
  }
  return last;
}

void expectSamePose(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

TEST(LockstepRun, AMapsViewIsTakenExactlySoManyFramesLater) {
  for (const int delay : {1, 5}) {
    Settings settings;
    settings.view_delay_frames = delay;
    const RunResult result = run(settings, {}, nullptr, 30);
    ASSERT_GE(mapMadeAt(result), 0) << result.frames.back().reason;
    EXPECT_EQ(firstTracked(result), mapMadeAt(result) + delay);
  }
}

TEST(LockstepRun, TheSameFramesGiveTheSameRunToTheLastBit) {
  const RunResult a = run(Settings()), b = run(Settings());
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].state, b.frames[i].state);
    EXPECT_EQ(a.frames[i].reason, b.frames[i].reason);
    EXPECT_EQ(a.frames[i].has_final_pose, b.frames[i].has_final_pose);
    EXPECT_EQ(standardDeviation(a.frames[i]), standardDeviation(b.frames[i]));
    EXPECT_EQ(a.frames[i].mapped_points, b.frames[i].mapped_points);
    expectSamePose(a.frames[i].world_T_camera, b.frames[i].world_T_camera);
    expectSamePose(a.frames[i].final_world_T_camera, b.frames[i].final_world_T_camera);
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) {
    EXPECT_EQ(a.keyframes[i].frame_index, b.keyframes[i].frame_index);
    expectSamePose(a.keyframes[i].world_T_camera, b.keyframes[i].world_T_camera);
  }
  ASSERT_EQ(a.map_points.size(), b.map_points.size());
  for (std::size_t i = 0; i < a.map_points.size(); ++i) {
    EXPECT_EQ(a.map_points[i].position, b.map_points[i].position);
    EXPECT_EQ(a.map_points[i].chain, b.map_points[i].chain);
  }
}

// While the camera has not been found yet there is no frame with a pose to draw.
TEST(LockstepRun, FramesAreDrawnAlsoBeforeTheCameraIsFoundInASavedMap) {
  const Recording& made = recording();
  LockstepRun first(made.sequence.camera, Settings(), lockstep_frames, 0);
  for (int i = 0; i < lockstep_frames; ++i) {
    first.process(i, made.sequence.time(i), made.images[static_cast<std::size_t>(i)]);
  }
  first.settle();
  ASSERT_FALSE(first.map().keyframes.empty());

  LockstepRun second(made.sequence.camera, Settings(), 10, 10);
  second.goOnWith(first.map());
  for (int i = 0; i < 10; ++i) {
    const FrameRecord& record = second.process(i, made.sequence.time(i), made.images[static_cast<std::size_t>(i)]);
    if (i == 0) {
      EXPECT_EQ(record.state, TrackingState::lost);
    }
  }
  const RunResult result = second.finish();
  ASSERT_EQ(result.drawings.size(), 10U);
  cv::Mat channels[3];
  cv::split(result.drawings[0].image, channels);
  EXPECT_GT(cv::countNonZero(channels[0] != channels[1]), 500) << "its edges are coloured";
}

// Localisation only: poses as from mapping, and the map is the same bytes.
TEST(LockstepRun, AFrozenMapIsLocalisedInAndStaysAsItIs) {
  const Recording& made = recording();
  LockstepRun first(made.sequence.camera, Settings(), lockstep_frames, 0);
  for (int i = 0; i < lockstep_frames; ++i) {
    first.process(i, made.sequence.time(i), made.images[static_cast<std::size_t>(i)]);
  }
  first.settle();
  ASSERT_FALSE(first.map().keyframes.empty());
  const std::string saved = encodeMap({made.sequence.camera, first.map()});

  Settings settings;
  settings.tracking.map_is_frozen = true;
  std::vector<RunResult> results;
  for (int again = 0; again < 2; ++again) {
    LockstepRun run(made.sequence.camera, settings, lockstep_frames, 0);
    run.goOnWith(first.map());
    for (int i = 0; i < lockstep_frames; ++i) {
      const std::int64_t index = lockstep_frames - 1 - i;  // backwards: it is another run
      run.process(i, made.sequence.time(i), made.images[static_cast<std::size_t>(index)]);
    }
    run.settle();
    EXPECT_TRUE(encodeMap({made.sequence.camera, run.map()}) == saved);
    results.push_back(run.finish());
  }
  int tracked = 0;
  for (std::size_t i = 0; i < results[0].frames.size(); ++i) {
    const FrameRecord &a = results[0].frames[i], &b = results[1].frames[i];
    EXPECT_EQ(a.state, b.state);
    expectSamePose(a.world_T_camera, b.world_T_camera);
    tracked += isGoodPose(a.state) ? 1 : 0;
    EXPECT_FALSE(a.is_keyframe);
  }
  EXPECT_GE(tracked, lockstep_frames - 10);
  EXPECT_TRUE(results[0].keyframes.empty()) << "none is of this run";
}

// Where nothing of it shows, poses are predicted and said to be so for a while, and never good.
TEST(LockstepRun, WhereAFrozenMapDoesNotShowPosesArePredictedThenLost) {
  const Recording& made = recording();
  LockstepRun first(made.sequence.camera, Settings(), lockstep_frames, 0);
  for (int i = 0; i < lockstep_frames; ++i) {
    first.process(i, made.sequence.time(i), made.images[static_cast<std::size_t>(i)]);
  }
  first.settle();
  Settings settings;
  settings.tracking.map_is_frozen = true;
  LockstepRun run(made.sequence.camera, settings, 200, 0);
  run.goOnWith(first.map());
  int at = 0;
  const auto show = [&](const cv::Mat& grey) -> const FrameRecord& {
    ++at;
    return run.process(at, made.sequence.time(at), grey);
  };
  for (int i = 0; i < 30; ++i) show(made.images[30]);
  ASSERT_EQ(run.latest().state, TrackingState::tracking) << run.latest().reason;
  const cv::Mat covered(made.images[0].size(), CV_8U, cv::Scalar(20));
  double last_sigma = 0;
  int predicted = 0;
  for (int i = 0; i < 60; ++i) {
    const FrameRecord& frame = show(covered);
    ASSERT_FALSE(isGoodPose(frame.state)) << i;
    EXPECT_NE(frame.reason, "");
    if (frame.state != TrackingState::predicted) continue;
    ++predicted;
    EXPECT_EQ(i + 1, predicted) << "first predicted, then lost";
    EXPECT_TRUE(frame.has_pose);
    EXPECT_GT(standardDeviation(frame)[0], last_sigma) << "it knows less and less";
    last_sigma = standardDeviation(frame)[0];
  }
  EXPECT_GE(predicted, 20);
  EXPECT_EQ(run.latest().state, TrackingState::lost);
  EXPECT_FALSE(run.latest().has_pose);
  bool found = false;
  for (int i = 0; i < 30; ++i) found = isGoodPose(show(made.images[30]).state) || found;
  EXPECT_TRUE(found) << "it is looked for in the map";
  EXPECT_EQ(run.latest().world, 0) << "and no other map is begun";
}

TEST(LockstepRun, WhatARunLeavesFitsTogether) {
  std::vector<FrameRecord> live;
  const RunResult result = run(Settings(), {}, &live);
  ASSERT_EQ(result.frames.size(), static_cast<std::size_t>(lockstep_frames));
  ASSERT_GE(firstTracked(result), 0);
  std::size_t final_poses = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameRecord& frame = result.frames[i];
    EXPECT_EQ(frame.index, static_cast<std::int64_t>(i));
    EXPECT_EQ(frame.time_ns, recording().sequence.time(static_cast<int>(i)));
    EXPECT_EQ(frame.state, live[i].state) << "what was given out stays as it was";
    expectSamePose(frame.world_T_camera, live[i].world_T_camera);
    EXPECT_EQ(frame.state == TrackingState::initialising, !frame.reason.empty()) << i << ": " << frame.reason;
    EXPECT_EQ(frame.has_pose, frame.state != TrackingState::initialising);
    if (frame.has_pose) {
      EXPECT_GT(frame.mapped_points, 20);
      EXPECT_GT(standardDeviation(frame).minCoeff(), 0);
    }
    final_poses += frame.has_final_pose;
  }
  EXPECT_GE(final_poses, static_cast<std::size_t>(lockstep_frames - 2))
      << "the frames before the map have poses as well";

  EXPECT_FALSE(result.map_points.empty());
  EXPECT_NE(result.initialisation, "");
  EXPECT_FALSE(result.drawings.empty());
  for (std::size_t k = 0; k < result.keyframes.size(); ++k) {
    const KeyframeRecord& keyframe = result.keyframes[k];
    EXPECT_EQ(keyframe.id, static_cast<int>(k));
    const FrameRecord& frame = result.frames[static_cast<std::size_t>(keyframe.frame_index)];
    EXPECT_TRUE(frame.is_keyframe);
    EXPECT_TRUE(k == 0 || keyframe.frame_index > result.keyframes[k - 1].frame_index);
    // A keyframe's own frame is carried by a keyframe near by.
    if (frame.has_final_pose) {
      EXPECT_LT((frame.final_world_T_camera.translation - keyframe.world_T_camera.translation).norm(), 0.02);
    }
  }
}

TEST(LockstepRun, UnreadableFramesArePredictedAndCounted) {
  const RunResult whole = run(Settings());
  const std::int64_t start = firstTracked(whole);
  ASSERT_GE(start, 0);
  ASSERT_LT(start, 35);
  const std::set<int> unreadable{40, 41, 50};
  const RunResult result = run(Settings(), unreadable);
  EXPECT_EQ(result.unreadable_frames, 3);
  ASSERT_EQ(result.frames.size(), static_cast<std::size_t>(lockstep_frames));
  for (int i = 0; i < lockstep_frames; ++i) {
    const FrameRecord& frame = result.frames[static_cast<std::size_t>(i)];
    if (unreadable.count(i) == 0) {
      EXPECT_EQ(frame.state, i < start ? TrackingState::initialising : TrackingState::tracking) << i;
      continue;
    }
    EXPECT_EQ(frame.state, TrackingState::predicted) << i;
    EXPECT_EQ(frame.reason, "frame " + std::to_string(i) + " is cut off");
    EXPECT_TRUE(frame.has_pose);
    EXPECT_FALSE(frame.has_final_pose) << "a guess is no good pose";
    EXPECT_LT((frame.world_T_camera.translation - whole.frames[static_cast<std::size_t>(i)].world_T_camera.translation)
                  .norm(),
              0.05);
    // Less is known of it than of the last measured one.
    const FrameRecord& before = result.frames[39];
    if (i == 41) {
      EXPECT_GT(standardDeviation(frame)[0], standardDeviation(before)[0]);
      EXPECT_GT(standardDeviation(frame)[3], standardDeviation(before)[3]);
    }
  }
}

TEST(LockstepRun, UnreadableFramesBeforeTheMapAreNoPoses) {
  const RunResult result = run(Settings(), {0, 1, 2, 5});
  EXPECT_EQ(result.unreadable_frames, 4);
  for (const std::size_t i : {0, 1, 2, 5}) {
    EXPECT_EQ(result.frames[i].state, TrackingState::initialising);
    EXPECT_FALSE(result.frames[i].has_pose);
    EXPECT_FALSE(result.frames[i].has_final_pose);
  }
  EXPECT_GE(firstTracked(result), 0) << "and the map starts all the same";
}

TEST(LockstepRun, WithoutAnyFrameThereIsNothing) {
  LockstepRun lockstep(recording().sequence.camera, Settings(), 0, 0);
  const RunResult result = lockstep.finish();
  EXPECT_TRUE(result.frames.empty() && result.keyframes.empty() && result.map_points.empty());
}

TEST(LockstepRun, ABlankImageMakesNoMapAndSaysWhy) {
  LockstepRun lockstep(recording().sequence.camera, Settings(), 0, 0);
  for (int i = 0; i < 10; ++i) {
    const FrameRecord& frame =
        lockstep.process(i, recording().sequence.time(i), cv::Mat(240, 320, CV_8U, cv::Scalar(120)));
    EXPECT_EQ(frame.state, TrackingState::initialising);
    EXPECT_NE(frame.reason, "");
    EXPECT_FALSE(frame.has_pose);
  }
  EXPECT_TRUE(lockstep.finish().keyframes.empty());
}

}  // namespace
}  // namespace edgeslam
