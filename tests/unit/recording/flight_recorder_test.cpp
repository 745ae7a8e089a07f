#include "recording/flight_recorder.h"

#include <gtest/gtest.h>

#include <thread>

#include "recording/recording_source.h"
#include "unit/image_formats/made_jpeg.h"
#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

std::shared_ptr<const FrameImages> imagesOf(int i) {
  auto images = std::make_shared<FrameImages>();
  images->frame_index = i;
  images->time_ns = madeTime(i);
  images->pyramid.levels.push_back(madeFrame(i));
  return images;
}

TEST(FlightRecorder, EndedWhileTheRunGoesOnItHasACleanEndAndNoGap) {
  for (int run = 0; run < 5; ++run) {
    const TemporaryFolder folder;
    FlightRecorder recorder(folder.path("recording"), madeDescription());
    std::atomic<bool> stopped{false};
    std::atomic<int> frames{0};
    std::thread tracking([&] {
      for (int i = 0; !stopped; ++i) {
        recorder.tookUpdate(i, i);
        recorder.processed(imagesOf(i), nullptr);
        ++frames;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
    while (frames < 10) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const RecordingStatus status = recorder.stop();
    const int at_end = frames;
    while (frames < at_end + 5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stopped = true;
    tracking.join();
    EXPECT_FALSE(status.recording);
    EXPECT_EQ(status.not_recorded, 0);
    const Recording recording = readRecording(folder.path("recording"));
    EXPECT_TRUE(recording.decisions.complete) << recording.decisions.note;
    EXPECT_GE(recording.frames.size(), 10U);
    EXPECT_EQ(recorder.stop().frames, status.frames) << "once more changes nothing";
  }
}

// As the camera sent it, unless that is more than a recording takes: then the image is.
TEST(FlightRecorder, AJpegOfTheCameraTakesTheImagesPlace) {
  const TemporaryFolder folder;
  FlightRecorder recorder(folder.path("recording"), madeDescription());
  const auto jpeg = std::make_shared<const std::vector<unsigned char>>(madeJpeg(madeFrame(0)));
  auto padded = std::make_shared<std::vector<unsigned char>>(*jpeg);
  padded->resize(static_cast<std::size_t>(largestArchivedImage(made_width, made_height)) + 1);
  const std::shared_ptr<const FrameImages> images = imagesOf(0);
  recorder.processed(images, jpeg);
  recorder.processed(imagesOf(1), padded);
  recorder.stop();
  EXPECT_EQ(images.use_count(), 1);
  const Recording recording = readRecording(folder.path("recording"));
  ASSERT_EQ(recording.frames.size(), 2U);
  EXPECT_EQ(recording.frames[0].image->size, static_cast<std::int64_t>(jpeg->size()));
  expectFramesAsMade(recording, [&](int i) {
    return i == 1 ? madeFrame(1) : decodedAsLive(*jpeg, {made_width, made_height});
  });
}

TEST(FlightRecorder, WhatAnInertialUnitMeasuredComesBeforeItsFrameInOrder) {
  const TemporaryFolder folder;
  FlightRecorder recorder(folder.path("recording"), madeDescription());
  std::vector<InertiaGiven> given;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 10 * i; ++k) {
      given.push_back({i, {madeTime(i) + 1000 * k, {0.001 * k, 0, 0.1 * i}, {0, 0, 9.8}}});
      recorder.measured(i, given.back().sample);
    }
    recorder.processed(imagesOf(i), nullptr);
  }
  EXPECT_EQ(recorder.stop().not_recorded, 0);
  const Recording recording = readRecording(folder.path("recording"));
  EXPECT_TRUE(recording.decisions.complete) << recording.decisions.note;
  ASSERT_EQ(recording.decisions.inertia.size(), given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(recording.decisions.inertia[i].frame_index, given[i].frame_index);
    EXPECT_EQ(recording.decisions.inertia[i].sample.time_ns, given[i].sample.time_ns);
    EXPECT_EQ(recording.decisions.inertia[i].sample.rate, given[i].sample.rate);
  }
  EXPECT_EQ(runDecisions(recording.decisions).inertia.at(3).size(), 30U);
}

TEST(FlightRecorder, WhatTheWheelsSaidComesBackToTheLastBit) {
  const TemporaryFolder folder;
  FlightRecorder recorder(folder.path("recording"), madeDescription());
  std::vector<WheelsGiven> given;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 5 * i; ++k) {
      const Eigen::Vector3d turn(0.01 * k, 1.0 / 3, -0.1 * i);
      given.push_back({i, {madeTime(i) / 1000 + k, {rotationExp(turn).normalized(), {1.0 / (k + 1), 0.1 * i, -1e-9}}}});
      recorder.measured(i, given.back().pose);
      recorder.measured(i, InertialSample{madeTime(i) + k, {0, 0, 0.1}, {0, 0, 9.8}});
    }
    recorder.processed(imagesOf(i), nullptr);
  }
  EXPECT_EQ(recorder.stop().not_recorded, 0);
  const Recording recording = readRecording(folder.path("recording"));
  EXPECT_TRUE(recording.decisions.complete) << recording.decisions.note;
  EXPECT_EQ(recording.decisions.inertia.size(), given.size());
  ASSERT_EQ(recording.decisions.wheels.size(), given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    const WheelsGiven& read = recording.decisions.wheels[i];
    EXPECT_EQ(read.frame_index, given[i].frame_index);
    EXPECT_EQ(read.pose.utime, given[i].pose.utime);
    EXPECT_EQ(read.pose.local_T_body.translation, given[i].pose.local_T_body.translation);
    EXPECT_EQ(read.pose.local_T_body.rotation.coeffs(), given[i].pose.local_T_body.rotation.coeffs());
  }
  EXPECT_EQ(runDecisions(recording.decisions).wheels.at(3).size(), 15U);
}

}  // namespace
}  // namespace edgeslam
