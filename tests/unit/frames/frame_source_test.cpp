#include "frames/frame_source.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "frames/folder_source.h"
#include "unit/files/temporary_folder.h"
#include "unit/frames/all_frames.h"

namespace edgeslam {
namespace {

const std::string kCamera = "width: 32\nheight: 24\nfx: 30\nfy: 30\ncx: 15\ncy: 11\n";

// Grey all over, so that frames can be told apart.
void writeImage(const TemporaryFolder& folder, const std::string& name, int grey, cv::Size size = {32, 24}) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", cv::Mat(size, CV_8UC1, cv::Scalar(grey)), bytes);
  folder.write(name, std::string(bytes.begin(), bytes.end()));
}

template <typename... Texts>
void expectFolderRefused(const TemporaryFolder& folder, const Texts&... texts) {
  expectInputError([&] { openFrames(folder.path()); }, texts...);
}

TEST(FrameSource, ReadsTumFolders) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "# color images\n# timestamp filename\n10.25 rgb/a.png\n10.5 rgb/b.png\n");
  folder.write("camera.yaml", kCamera);
  folder.write("groundtruth.txt", "10 0 0 0 0 0 0 1\n");
  writeImage(folder, "rgb/a.png", 10);
  writeImage(folder, "rgb/b.png", 20);
  const auto source = openFrames(folder.path() + "/");
  EXPECT_EQ(source->size(), 2);
  EXPECT_NE(source->kind().find("TUM"), std::string::npos);
  ASSERT_TRUE(source->camera());
  EXPECT_EQ(source->camera()->width, 32);
  EXPECT_TRUE(std::filesystem::equivalent(source->groundTruthPath(), folder.path("groundtruth.txt")));
  const std::vector<Frame> frames = readAll(*source);
  ASSERT_EQ(frames.size(), 2U);
  for (int i = 0; i < 2; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.time_ns, 10250000000 + 250000000 * i);
    EXPECT_EQ(frame.problem, "");
    EXPECT_EQ(frame.grey.type(), CV_8UC1);
    EXPECT_EQ(frame.grey.at<unsigned char>(0, 0), 10 * (i + 1));
  }
  EXPECT_FALSE(source->next());
}

TEST(FrameSource, ReadsAssociationsInEitherOrder) {
  for (const char* line : {"1 rgb/1.png 1 depth/1.png\n", "1 depth/1.png 1 rgb/1.png\n"}) {
    const TemporaryFolder folder;
    folder.write("associations.txt", line);
    folder.write("traj0.gt.freiburg", "1 0 0 0 0 0 0 1\n");
    writeImage(folder, "rgb/1.png", 77);
    writeImage(folder, "depth/1.png", 3);
    const auto source = openFrames(folder.path());
    const std::vector<Frame> frames = readAll(*source);
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].grey.at<unsigned char>(0, 0), 77);
    EXPECT_FALSE(source->camera());
    EXPECT_EQ(source->groundTruthPath(), folder.path("traj0.gt.freiburg"));
  }
}

TEST(FrameSource, ReadsEurocFoldersAtEveryLevel) {
  const TemporaryFolder folder;
  folder.write("mav0/cam0/data.csv",
               "#timestamp [ns],filename\r\n1403636579763555584,1403636579763555584.png\r\n"
               "1403636579813555456,1403636579813555456.png\r\n");
  writeImage(folder, "mav0/cam0/data/1403636579763555584.png", 1);
  writeImage(folder, "mav0/cam0/data/1403636579813555456.png", 2);
  folder.write("mav0/cam0/sensor.yaml",
               "sensor_type: camera\nresolution: [32, 24]\ncamera_model: pinhole\nintrinsics: [30, 30, 15, 11]\n"
               "distortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n");
  folder.write("mav0/state_groundtruth_estimate0/data.csv", "1403636579763555584,0,0,0,1,0,0,0\n");
  for (const char* level : {"", "mav0", "mav0/cam0", "mav0/cam0/"}) {
    SCOPED_TRACE(level);
    const auto source = openFrames(folder.path(level));
    EXPECT_EQ(source->kind(), "EuRoC folder");
    ASSERT_TRUE(source->camera());
    EXPECT_EQ(source->camera()->fx, 30);
    EXPECT_TRUE(std::filesystem::equivalent(source->groundTruthPath(),
                                            folder.path("mav0/state_groundtruth_estimate0/data.csv")));
    const std::vector<Frame> frames = readAll(*source);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[1].time_ns, 1403636579813555456);
    EXPECT_EQ(frames[1].grey.at<unsigned char>(0, 0), 2);
  }
}

TEST(FrameSource, ReadsImagesNamedByTimeInTheOrderOfTime) {
  const TemporaryFolder seconds, nanoseconds;
  for (const char* name : {"9.5.png", "10.5.png", "100.25.png"}) writeImage(seconds, name, 5);
  seconds.write("notes.txt", "no image");
  const std::vector<Frame> frames = readAll(*openFrames(seconds.path()));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].time_ns, 9500000000);
  EXPECT_EQ(frames[1].time_ns, 10500000000);
  EXPECT_EQ(frames[2].time_ns, 100250000000);
  writeImage(nanoseconds, "1403636579813555456.png", 5);
  EXPECT_EQ(readAll(*openFrames(nanoseconds.path()))[0].time_ns, 1403636579813555456);
}

TEST(FrameSource, NamesThatAreNoTimeStampsAreRefused) {
  for (const char* name : {"000001.png", "frame.png", "12.png", "img_1.5.png"}) {
    const TemporaryFolder folder;
    writeImage(folder, name, 5);
    expectFolderRefused(folder, name, "seconds with a decimal point", "nanoseconds");
  }
  const TemporaryFolder folder;
  writeImage(folder, "1.5.png", 5);
  writeImage(folder, "1.50.png", 5);
  expectFolderRefused(folder, "1.5.png", "1.50.png", "same time stamp");
}

TEST(FrameSource, TimeStampsThatGoBackOrRepeatAreToldByLine) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "# c\n1.5 a.png\n1.25 b.png\n");
  expectFolderRefused(folder, "rgb.txt:3", "lies before", "1.25");
  folder.write("rgb.txt", "1.5 a.png\n1.50 b.png\n");
  expectFolderRefused(folder, "rgb.txt:2", "same");
  const TemporaryFolder euroc;
  std::filesystem::create_directories(euroc.path("cam0/data"));
  euroc.write("cam0/data.csv", "#t\n2000,a.png\n1000,b.png\n");
  expectFolderRefused(euroc, "data.csv:3", "lies before");
}

TEST(FrameSource, ALastLineThatWasTornIsLeftOut) {
  const std::string list = "10.25 a.png\n10.5 b.png\n";
  const TemporaryFolder folder;
  for (const char* torn : {"1", "10.", "10.75", "10.75 ", "x"}) {
    folder.write("rgb.txt", list + torn);
    EXPECT_EQ(readTumImageList(folder.path("rgb.txt")).size(), 2U) << torn;
    folder.write("rgb.txt", list + torn + "\n");
    expectInputError([&] { readTumImageList(folder.path("rgb.txt")); }, "rgb.txt:3");
  }
  folder.write("rgb.txt", list + "10.75 c.png");
  EXPECT_EQ(readTumImageList(folder.path("rgb.txt")).size(), 3U) << "an editor that writes no last line end";
}

TEST(FrameSource, BadListsAreToldByLine) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "# only comments\n\n");
  expectFolderRefused(folder, "rgb.txt", "lists no frames");
  folder.write("rgb.txt", "1.5\n");
  expectFolderRefused(folder, "rgb.txt:1", "time-stamp file");
  folder.write("rgb.txt", "nan a.png\n");
  expectFolderRefused(folder, "rgb.txt:1", "nan", "time stamp");
  folder.write("rgb.txt", std::string("\0\xff\x01 \x02", 5));
  expectFolderRefused(folder, "rgb.txt:1");
  folder.write("rgb.txt", "1.5 rgb/\x1b[31m.png\n");
  expectFolderRefused(folder, "rgb.txt:1", "control characters");
}

TEST(FrameSource, ASingleBadFrameIsAProblemAndTheNextOneIsRead) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "1 a.png\n2 missing.png\n3 cut.png\n4 small.png\n5 e.png\n");
  writeImage(folder, "a.png", 1);
  writeImage(folder, "e.png", 5);
  writeImage(folder, "small.png", 4, {16, 12});
  const std::string whole = fileContent(folder.path("a.png"));
  folder.write("cut.png", whole.substr(0, whole.size() / 2));
  const std::vector<Frame> frames = readAll(*openFrames(folder.path()));
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_NE(frames[1].problem.find("missing.png: no such file"), std::string::npos);
  EXPECT_NE(frames[2].problem.find("cut.png"), std::string::npos);
  EXPECT_NE(frames[3].problem.find("16 x 12"), std::string::npos);
  EXPECT_NE(frames[3].problem.find("32 x 24"), std::string::npos);
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
    EXPECT_TRUE(frames[i].grey.empty());
    EXPECT_EQ(frames[i].index, static_cast<std::int64_t>(i));
  }
  EXPECT_EQ(frames[4].problem, "");
  EXPECT_EQ(frames[4].grey.at<unsigned char>(0, 0), 5);
}

TEST(FrameSource, ImagesOfAnotherSizeThanTheCalibrationAreProblems) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "1 a.png\n2 b.png\n");
  folder.write("camera.yaml", kCamera);
  writeImage(folder, "a.png", 1, {64, 48});
  writeImage(folder, "b.png", 2);
  const std::vector<Frame> frames = readAll(*openFrames(folder.path()));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_NE(frames[0].problem.find("64 x 48"), std::string::npos);
  EXPECT_NE(frames[0].problem.find("camera.yaml says 32 x 24"), std::string::npos);
  EXPECT_EQ(frames[1].problem, "");
}

TEST(FrameSource, FindsEveryKindOfCalibration) {
  const std::string kalibr =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: radtan\n"
      "  intrinsics: [31, 30, 15, 11]\n  resolution: [32, 24]\n";
  const TemporaryFolder folder;
  writeImage(folder, "1.5.png", 1);
  folder.write("camchain-desk.yaml", kalibr);
  ASSERT_TRUE(openFrames(folder.path())->camera());
  EXPECT_EQ(openFrames(folder.path())->camera()->fx, 31);
  folder.write("camera.yaml", kCamera);
  EXPECT_EQ(openFrames(folder.path())->camera()->fx, 30) << "our own comes first";
  folder.write("camera.yaml", "width: nan\n");
  expectFolderRefused(folder, "camera.yaml:1", "width");
}

TEST(FrameSource, WhatHoldsNoFramesIsRefused) {
  const TemporaryFolder folder;
  expectFolderRefused(folder, "empty folder", "rgb.txt");
  folder.write("notes.txt", "no frames");
  expectFolderRefused(folder, "holds no frames", "rgb.txt");
  expectInputError([&] { openFrames(folder.path("none")); }, "none", "no such folder or video");
  expectInputError([&] { openFrames(folder.path("notes.txt")); }, "notes.txt", "expected a folder");
  expectInputError([&] { openFrames(""); }, "no such");
}

TEST(FrameSource, ReadsTheSharedSequencesWhole) {
  const std::string data = std::string(EDGESLAM_SOURCE_DIR) + "/../shared/data/";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no shared sequences in " << data;
  const std::pair<const char*, std::int64_t> sequences[]{{"notex_far", 780}, {"calib_board", 60}};
  for (const auto& [name, count] : sequences) {
    const auto source = openFrames(data + name);
    EXPECT_TRUE(source->camera());
    EXPECT_NE(source->groundTruthPath(), "");
    std::int64_t read = 0;
    for (std::optional<Frame> frame = source->next(); frame; frame = source->next(), ++read) {
      EXPECT_EQ(frame->problem, "");
    }
    EXPECT_EQ(read, count) << name;
  }
}

}  // namespace
}  // namespace edgeslam
