#include "frames/frame_folder_writer.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "frames/frame_source.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const cv::Mat written_image(24, 32, CV_8U, cv::Scalar(50));

TEST(FrameFolderWriter, IsReadableWhileItIsWritten) {
  const TemporaryFolder folder;
  FrameFolderWriter writer(folder.path("r"), std::nullopt, "a camera", 0);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(writer.write(i * 1'000'000'007LL, written_image), "");
    const std::unique_ptr<FrameSource> source = openFrames(folder.path("r"));
    EXPECT_EQ(source->size(), i);
    EXPECT_FALSE(source->camera());
  }
  EXPECT_EQ(writer.frames(), 3);
  EXPECT_GT(writer.bytes(), 0);
  EXPECT_EQ(writer.close(), "");
}

TEST(FrameFolderWriter, WritesOnlyToANewOrEmptyFolder) {
  const TemporaryFolder folder;
  folder.write("used/file", "");
  folder.write("file", "");
  expectInputError([&] { FrameFolderWriter(folder.path("used"), std::nullopt, "", 0); }, "used", "not an empty folder");
  expectInputError([&] { FrameFolderWriter(folder.path("file"), std::nullopt, "", 0); }, "file");
  expectInputError([&] { FrameFolderWriter("/proc/none", std::nullopt, "", 0); }, "/proc/none");
}

TEST(FrameFolderWriter, LeavesTheDiskItsFreeSpace) {
  const TemporaryFolder folder;
  expectInputError([&] { FrameFolderWriter(folder.path("r"), std::nullopt, "", std::int64_t{1} << 60); }, "MiB free");
  EXPECT_FALSE(std::filesystem::exists(folder.path("r")));
}

TEST(FrameFolderWriter, TimeStampsGrow) {
  const TemporaryFolder folder;
  FrameFolderWriter writer(folder.path("r"), std::nullopt, "", 0);
  EXPECT_EQ(writer.write(100, written_image), "");
  EXPECT_NE(writer.write(100, written_image), "");
  EXPECT_NE(writer.write(200, written_image), "") << "writes on after a problem";
  EXPECT_EQ(openFrames(folder.path("r"))->size(), 1);
}

}  // namespace
}  // namespace edgeslam
