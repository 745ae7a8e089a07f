#include "service/status_text.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(StatusText, OneLostFrameIsNotWorthALine) {
  EXPECT_EQ(logText(TrackingState::tracking, ""), "tracking");
  EXPECT_EQ(logText(TrackingState::predicted, "blurred"), "");
  EXPECT_EQ(logText(TrackingState::lost, "covered"), "lost, covered");
  EXPECT_EQ(logText(TrackingState::initialising, ""), "initialising");
}

TEST(StatusText, TheServiceManagerSeesTheMapAndTheRecording) {
  PublisherStatus status;
  status.keyframes = 3;
  status.points = 400;
  EXPECT_EQ(serviceText(status, TrackingState::tracking, false), "tracking, 3 keyframes, 400 points");
  status.recording = true;
  EXPECT_EQ(serviceText(status, TrackingState::lost, true), "lost, 3 keyframes, 400 points, recording with gaps");
  status.worlds = 2;
  EXPECT_EQ(serviceText(status, TrackingState::tracking, false),
            "tracking, 3 keyframes, 400 points in 2 maps, recording");
  status.camera_problem = "/dev/video0 is gone";
  EXPECT_EQ(serviceText(status, TrackingState::lost, true), "no camera: /dev/video0 is gone");
}

}  // namespace
}  // namespace edgeslam
