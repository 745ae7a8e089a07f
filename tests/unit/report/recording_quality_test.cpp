#include "report/recording_quality.h"

#include <gtest/gtest.h>

#include "report/run_summary.h"
#include "unit/report/made_run.h"

namespace edgeslam {
namespace {

void blurEvery(RunResult& run, std::size_t stride) {
  for (std::size_t i = made_initialising_frames; i < run.frames.size(); i += stride) {
    run.frames[i].state = TrackingState::predicted;
    const bool is_followed = i / stride % 2 == 1;
    if (is_followed) run.frames[i].state = TrackingState::tracking;
    run.frames[i].reason = is_followed ? "followed coarsely: blurred image" : "blurred image";
  }
}

void leaveOut(RunResult& run, std::size_t from, std::int64_t frames) {
  for (std::size_t i = from; i < run.frames.size(); ++i) run.frames[i].time_ns += frames * 33333333;
}

TEST(RecordingQuality, ofAGoodRecordingNothingIsTold) {
  RunResult run = makeRun();
  EXPECT_EQ(recordingQuality(run), "");
  EXPECT_EQ(recordingQuality(RunResult()), "");
  for (FrameRecord& frame : run.frames) frame.noise_factor = 2;
  blurEvery(run, 22);     // 5 of 120 frames
  leaveOut(run, 50, 30);  // 1 of 119 intervals
  EXPECT_EQ(recordingQuality(run), "");
}

TEST(RecordingQuality, measurementsThatErrFarAreTold) {
  RunResult run = makeRun();
  for (FrameRecord& frame : run.frames) frame.noise_factor = frame.has_pose ? 2.9 : 1;
  EXPECT_EQ(recordingQuality(run),
            "measurements err 2.9 times as far as a good camera's: check the calibration, or the camera has a rolling "
            "shutter (docs/calibrating.md)");
  for (std::size_t i = 0; i < 70; ++i) run.frames[i].noise_factor = 1;
  EXPECT_EQ(recordingQuality(run), "") << "the median is a good camera's";
}

TEST(RecordingQuality, blurIsTold) {
  RunResult run = makeRun();
  blurEvery(run, 10);
  EXPECT_EQ(recordingQuality(run), "9 % of the frames are blurred: a shorter exposure helps (docs/mounting.md)");
}

TEST(RecordingQuality, gapsAreToldWithTheLongest) {
  RunResult run = makeRun();
  leaveOut(run, 40, 14);
  leaveOut(run, 80, 2);
  EXPECT_EQ(recordingQuality(run),
            "frames are missing in 2 places, the longest gap is 0.5 s: look at the camera's cable and at how it was "
            "recorded");
  run.dropped_frames = 16;
  EXPECT_EQ(recordingQuality(run), "") << "the run left them out, not the recording";
}

TEST(RecordingQuality, theWorstComesFirst) {
  RunResult run = makeRun();
  for (FrameRecord& frame : run.frames) frame.noise_factor = 2.1;
  blurEvery(run, 2);
  leaveOut(run, 40, 14);
  leaveOut(run, 80, 2);
  const std::string line = recordingQuality(run);
  EXPECT_EQ(line.find("46 % of the frames are blurred"), 0U) << line;
  EXPECT_LT(line.find("; frames are missing"), line.find("; measurements err")) << line;
  EXPECT_EQ(summarise(run, std::nullopt).recording_quality, line);
}

}  // namespace
}  // namespace edgeslam
