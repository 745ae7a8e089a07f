#include "frames/video_source.h"

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "unit/files/temporary_folder.h"
#include "unit/frames/all_frames.h"

namespace edgeslam {
namespace {

constexpr int kFrames = 6;

std::string writeVideo(const TemporaryFolder& folder, const std::string& name) {
  const std::string path = folder.path(name);
  cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {64, 48});
  if (!writer.isOpened()) throw std::runtime_error("OpenCV writes no video");
  for (int i = 0; i < kFrames; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(30 * (i + 1))));
  return path;
}

std::string times(int count) {
  std::string text = "# time stamps\n";
  for (int i = 0; i < count; ++i) text += std::to_string(100 + i * i) + ".5\n";
  return text;
}

TEST(VideoSource, TakesItsTimesFromTheListAndNotFromTheVideo) {
  const TemporaryFolder folder;
  writeVideo(folder, "video.avi");
  folder.write("times.txt", times(kFrames));
  const auto source = openFrames(folder.path());
  EXPECT_EQ(source->kind(), "video with times.txt");
  EXPECT_EQ(source->size(), kFrames);
  const std::vector<Frame> frames = readAll(*source);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.time_ns, 1'000'000'000LL * (100 + i * i) + 500'000'000);
    ASSERT_EQ(frame.grey.type(), CV_8UC1);
    EXPECT_EQ(frame.grey.size(), cv::Size(64, 48));
    EXPECT_NEAR(frame.grey.at<unsigned char>(20, 20), 30 * (i + 1), 3);
  }
}

TEST(VideoSource, AnotherNumberOfFramesThanOfStampsIsToldAtTheEnd) {
  for (const int count : {kFrames - 2, kFrames + 3}) {
    const TemporaryFolder folder;
    writeVideo(folder, "video.avi");
    folder.write("times.txt", times(count));
    const auto source = openFrames(folder.path());
    for (int i = 0; i < std::min(count, kFrames); ++i) ASSERT_TRUE(source->next()) << i;
    expectInputError([&] { source->next(); }, "holds 6 frames", std::to_string(count) + " time stamps",
                     count > kFrames ? "3 frames are missing" : "2 time stamps are missing");
  }
}

TEST(VideoSource, BadStampsAreToldByLine) {
  const TemporaryFolder folder;
  writeVideo(folder, "video.avi");
  const auto open = [&] { openFrames(folder.path()); };
  folder.write("times.txt", "1\n2\n1.5\n");
  expectInputError(open, "times.txt:3", "lies before");
  folder.write("times.txt", "# t\n1\n1\n");
  expectInputError(open, "times.txt:3", "same");
  folder.write("times.txt", "1\nx\n");
  expectInputError(open, "times.txt:2", "'x'");
  folder.write("times.txt", ",\n");
  expectInputError(open, "times.txt:1");
  folder.write("times.txt", "");
  expectInputError(open, "times.txt", "no time stamps");
}

TEST(VideoSource, ASingleVideoHasItsOwnTiming) {
  const TemporaryFolder folder;
  const std::string path = writeVideo(folder, "walk.avi");
  folder.write("camera.yaml", "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 31\ncy: 23\n");
  for (const std::string& given : {path, folder.path()}) {
    const auto source = openFrames(given);
    EXPECT_EQ(source->kind(), "video");
    EXPECT_TRUE(source->camera());
    const std::vector<Frame> frames = readAll(*source);
    ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
    for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_EQ(frames[i].time_ns - frames[i - 1].time_ns, 40'000'000);
  }
}

TEST(VideoSource, FramesOfAnotherSizeThanTheCalibrationAreProblems) {
  const TemporaryFolder folder;
  writeVideo(folder, "walk.avi");
  folder.write("camera.yaml", "width: 640\nheight: 480\nfx: 600\nfy: 600\ncx: 310\ncy: 230\n");
  const std::vector<Frame> frames = readAll(*openFrames(folder.path()));
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NE(frames[0].problem.find("64 x 48"), std::string::npos);
  EXPECT_NE(frames[0].problem.find("640 x 480"), std::string::npos);
}

TEST(VideoSource, DamagedVideosAreRefused) {
  const TemporaryFolder folder;
  folder.write("empty/v.mp4", "");
  folder.write("text/v.mp4", "this is no video, whatever its name says");
  for (const char* name : {"empty", "text"}) {
    expectInputError([&] { openFrames(folder.path(name)); }, "v.mp4", "cannot be opened as a video");
  }
  std::filesystem::create_directories(folder.path("folder.mp4"));
  expectInputError([&] { openFrames(folder.path("folder.mp4")); }, "empty folder");
}

TEST(VideoSource, SeveralVideosInOneFolderAreRefused) {
  const TemporaryFolder folder;
  folder.write("a.mp4", "");
  folder.write("b.mkv", "");
  expectInputError([&] { openFrames(folder.path()); }, "several videos", "a.mp4", "b.mkv");
}

TEST(VideoSource, AVideoThatWasCutOffTellsHowManyFramesAreMissing) {
  const TemporaryFolder folder;
  const std::string whole = fileContent(writeVideo(folder, "whole.avi"));
  folder.write("cut/video.avi", whole.substr(0, whole.size() / 2));
  folder.write("cut/times.txt", times(kFrames));
  expectInputError(
      [&] {
        const auto source = openFrames(folder.path("cut"));
        while (source->next()) {
        }
      },
      "video.avi");
}

TEST(VideoSource, TellsItsSizeOnlyWhereItBringsItsOwnTimes) {
  const TemporaryFolder folder;
  EXPECT_EQ(openFrames(writeVideo(folder, "walk.avi"))->videoSize(), cv::Size(64, 48));
  const TemporaryFolder stamped;
  writeVideo(stamped, "video.avi");
  stamped.write("times.txt", "0.1\n0.2\n");
  EXPECT_TRUE(openFrames(stamped.path(""))->videoSize().empty());
}

}  // namespace
}  // namespace edgeslam
