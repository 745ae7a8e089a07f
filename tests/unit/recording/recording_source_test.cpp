#include "recording/recording_source.h"

#include <random>

#include "frames/folder_source.h"
#include "frames/mask_file.h"
#include "recording/open_frame_source.h"
#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

class RecordingSourceTest : public TestInMemory {
 protected:
  RecordingSourceTest() {
    writeMadeRecording(path_);
    whole_ = fileContent(path_ + "/decisions.txt");
  }

  Recording readWith(const std::string& decisions) const {
    folder_.write("recording/decisions.txt", decisions);
    return readRecording(path_);
  }

  // A line as the recorder would write it, whatever it says.
  static std::string checked(const std::string& text) {
    std::string line = text + " " + checksumOf(text) + "\n";
    EXPECT_TRUE(undamagedDecision(std::string_view(line).substr(0, line.size() - 1)));
    return line;
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.path("recording");
  std::string whole_;

 private:
  // CRC-32 bit by bit (ISO 3309).
  static std::string checksumOf(const std::string& text) {
    std::uint32_t value = 0xFFFFFFFFU;
    for (const char c : text) {
      value ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    std::string digits(9, ' ');
    std::snprintf(digits.data(), digits.size(), "%08x", static_cast<unsigned>(~value));
    digits.pop_back();
    return digits;
  }
};

// Those of the first lines, as the whole recording has them.
void expectPrefix(const Recording& part, const Recording& whole) {
  ASSERT_LE(part.frames.size(), whole.frames.size());
  for (std::size_t i = 0; i < part.frames.size(); ++i) {
    EXPECT_EQ(part.frames[i].index, whole.frames[i].index);
    EXPECT_EQ(part.frames[i].time_ns, whole.frames[i].time_ns);
    EXPECT_EQ(part.frames[i].problem, whole.frames[i].problem);
  }
  ASSERT_LE(part.decisions.updates.size(), whole.decisions.updates.size());
  for (std::size_t i = 0; i < part.decisions.updates.size(); ++i) {
    EXPECT_EQ(part.decisions.updates[i].frame_index, whole.decisions.updates[i].frame_index);
    EXPECT_EQ(part.decisions.updates[i].number, whole.decisions.updates[i].number);
  }
  ASSERT_LE(part.decisions.corrections.size(), whole.decisions.corrections.size());
  ASSERT_LE(part.decisions.dropped.size(), whole.decisions.dropped.size());
  EXPECT_EQ(part.decisions.not_recorded, 0);
}

std::size_t linesOf(const Recording& recording) {
  const Decisions& decisions = recording.decisions;
  return recording.frames.size() + decisions.updates.size() + decisions.corrections.size() + decisions.dropped.size();
}

TEST_F(RecordingSourceTest, GivesBackWhatWasWritten) {
  const Recording recording = readRecording(path_);
  EXPECT_EQ(recording.program_version, "0.1.0");
  EXPECT_EQ(fileContent(recording.configuration_path), madeDescription().configuration);
  EXPECT_EQ(recording.camera.fy, madeDescription().camera.fy);
  ASSERT_EQ(recording.frames.size(), 11U);
  std::vector<std::int64_t> indices;
  for (const RecordedFrame& frame : recording.frames) indices.push_back(frame.index);
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(recording.frames[6].problem, "the cable is loose");
  expectFramesAsMade(recording, madeFrame);
  const Decisions& decisions = recording.decisions;
  ASSERT_EQ(decisions.dropped.size(), 1U);
  EXPECT_EQ(decisions.dropped[0].index, 3);
  EXPECT_EQ(decisions.dropped[0].time_ns, madeTime(3));
  ASSERT_EQ(decisions.updates.size(), 3U);
  EXPECT_EQ(decisions.updates[2].frame_index, 9);
  EXPECT_EQ(decisions.updates[2].number, 109);
  ASSERT_EQ(decisions.corrections.size(), 3U);
  EXPECT_EQ(decisions.corrections[1].message, 1);
  EXPECT_EQ(decisions.corrections[1].number, 56);
  EXPECT_TRUE(decisions.complete);
  EXPECT_EQ(decisions.note, "");
  EXPECT_EQ(decisions.not_recorded, 0);
}

TEST_F(RecordingSourceTest, IsKnownBeforeATumFolder) {
  folder_.write("recording/groundtruth.txt", "1 0 0 0 0 0 0 1\n");
  const auto source = openFrameSource(path_);
  EXPECT_EQ(source->kind(), "recording");
  EXPECT_EQ(source->size(), 11);
  ASSERT_TRUE(source->camera());
  EXPECT_EQ(source->camera()->width, made_width);
  EXPECT_EQ(source->groundTruthPath(), path_ + "/groundtruth.txt");
}

// What other programs see: a list of files that are all there, and time stamps to the nanosecond.
TEST_F(RecordingSourceTest, IsATumFolderToOthers) {
  std::filesystem::remove(path_ + "/recording.txt");
  EXPECT_FALSE(isRecording(path_));
  const auto source = openFrameSource(path_);
  EXPECT_EQ(source->kind(), "TUM RGB-D folder");
  int count = 0;
  while (const std::optional<Frame> frame = source->next()) {
    const int index = count + (count >= 3 ? 1 : 0) + (count >= 6 ? 1 : 0);
    EXPECT_EQ(frame->time_ns, madeTime(index));
    EXPECT_TRUE(same(frame->grey, madeFrame(index)));
    ++count;
  }
  EXPECT_EQ(count, 10);
  EXPECT_EQ(source->camera()->fy, madeDescription().camera.fy);
}

TEST_F(RecordingSourceTest, EveryTruncationLeavesAReadablePrefix) {
  const Recording whole = readRecording(path_);
  std::size_t before = 0;
  for (std::size_t size = 0; size < whole_.size(); ++size) {
    SCOPED_TRACE(size);
    const Recording part = readWith(whole_.substr(0, size));
    expectPrefix(part, whole);
    EXPECT_GE(linesOf(part), before);
    before = linesOf(part);
    if (size + 1 < whole_.size()) {
      EXPECT_FALSE(part.decisions.complete);
    }
    EXPECT_EQ(part.decisions.complete, part.decisions.note.empty());
  }
  EXPECT_EQ(before, linesOf(whole));
}

TEST_F(RecordingSourceTest, AFlippedByteEndsTheRecordingThere) {
  const Recording whole = readRecording(path_);
  std::mt19937 random(3);
  std::size_t line = 1, lines_before = 0;
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    SCOPED_TRACE(i);
    std::string damaged = whole_;
    damaged[i] = static_cast<char>(damaged[i] ^ static_cast<char>(1U << (random() % 8)));
    const Recording part = readWith(damaged);
    expectPrefix(part, whole);
    EXPECT_EQ(linesOf(part), lines_before);
    EXPECT_FALSE(part.decisions.complete);
    EXPECT_NE(part.decisions.note.find("decisions.txt:" + std::to_string(line) + ": "), std::string::npos)
        << part.decisions.note;
    if (whole_[i] == '\n') {
      ++line;
      ++lines_before;
    }
  }
}

TEST_F(RecordingSourceTest, ABlockOfZerosEndsTheRecordingThere) {
  std::string damaged = whole_;
  std::fill(damaged.begin() + 200, damaged.end(), '\0');
  const Recording part = readWith(damaged);
  EXPECT_GT(part.frames.size(), 0U);
  EXPECT_NE(part.decisions.note.find("torn or damaged"), std::string::npos);
}

TEST_F(RecordingSourceTest, HostileLinesAreToldByFileAndLine) {
  const std::string start = checked("frame 0 " + std::to_string(madeTime(0)));
  for (const std::string text :
       {"frame 1 99999999999999999999", "frame 99999999999999999999 1", "frame -1 5", "frame one two", "frame 0 5",
        "frame 1 5", "dropped 0 5", "update -1 3", "update 3 x", "gap -7", "gap 4000000000000000001", "nonsense",
        "frame", "correction 1", "end of it", "unreadable 0 1 x"}) {
    SCOPED_TRACE(text);
    expectInputError([&] { readWith(start + checked(text)); }, path_ + "/decisions.txt:2: ");
  }
  expectInputError([&] { readWith(start + checked("update 5 1") + checked("update 4 2")); }, "decisions.txt:3: ");
  expectInputError([&] { readWith(start + checked("end") + checked("update 5 1")); }, "decisions.txt:3: ", "follow");
  const std::vector<std::string> lines{checked("frame 1 " + std::to_string(madeTime(1))), start};
  expectInputError([&] { readWith(lines[0] + lines[1]); }, "decisions.txt:2: ", "must increase");
}

TEST_F(RecordingSourceTest, GapsAreCountedHoweverMany) {
  const std::string start = checked("frame 0 " + std::to_string(madeTime(0)));
  const Recording some = readWith(start + checked("gap 3") + checked("gap 4") + checked("end"));
  EXPECT_EQ(some.decisions.not_recorded, 7);
  EXPECT_FALSE(some.decisions.complete);
  EXPECT_NE(some.decisions.note.find("7 frames or decisions"), std::string::npos);
  std::string most = start;
  for (int i = 0; i < 4; ++i) most += checked("gap 4000000000000000000");
  EXPECT_EQ(readWith(most).decisions.not_recorded, std::numeric_limits<std::int64_t>::max());
}

TEST_F(RecordingSourceTest, FramesMissingAtTheEndEndTheRecordingThere) {
  const auto file = [this](int i) { return path_ + "/rgb/" + tumFrameName(madeTime(i)); };
  std::filesystem::remove(file(11));
  std::filesystem::resize_file(file(10), std::filesystem::file_size(file(10)) - 1);
  std::filesystem::resize_file(file(9), 0);
  const Recording recording = readRecording(path_);
  EXPECT_EQ(recording.frames.back().index, 8);
  EXPECT_EQ(recording.frames.size(), 8U);
  EXPECT_FALSE(recording.decisions.complete);
  EXPECT_NE(recording.decisions.note.find(file(9)), std::string::npos) << recording.decisions.note;
  EXPECT_NE(recording.decisions.note.find("before frame 9"), std::string::npos);
  expectFramesAsMade(recording, madeFrame);
}

TEST_F(RecordingSourceTest, ASingleMissingOrDamagedFrameIsAProblemAndTheNextOneIsRead) {
  std::filesystem::remove(path_ + "/rgb/" + tumFrameName(madeTime(1)));
  const std::string damaged = "recording/rgb/" + tumFrameName(madeTime(4));
  std::string content = fileContent(folder_.path(damaged));
  std::fill(content.begin() + 100, content.begin() + 200, '\0');
  folder_.write(damaged, content);
  RecordingSource source(readRecording(path_));
  EXPECT_EQ(source.size(), 11);
  int problems = 0;
  while (const std::optional<Frame> frame = source.next()) {
    const bool bad = frame->index == 1 || frame->index == 4 || frame->index == 7;
    EXPECT_EQ(frame->problem.empty(), !bad) << frame->problem;
    EXPECT_EQ(frame->grey.empty(), bad);
    problems += bad ? 1 : 0;
  }
  EXPECT_EQ(problems, 3);
}

TEST_F(RecordingSourceTest, AFrameOfAnotherSizeIsAProblem) {
  std::string camera = fileContent(path_ + "/camera.yaml");
  camera.replace(camera.find("width: 32"), 9, "width: 33");
  folder_.write("recording/camera.yaml", camera);
  RecordingSource source(readRecording(path_));
  const std::optional<Frame> frame = source.next();
  ASSERT_TRUE(frame);
  EXPECT_NE(frame->problem.find("33"), std::string::npos) << frame->problem;
}

TEST_F(RecordingSourceTest, MissingAndForeignFilesAreTold) {
  folder_.write("recording/recording.txt", "format 3\nprogram 9\n");
  expectInputError([&] { readRecording(path_); }, "recording.txt:1", "version 3", "version 1 to 2");
  folder_.write("recording/recording.txt", "format 1\nprogram 0.1\n");
  EXPECT_EQ(readRecording(path_).program_version, "0.1");
  folder_.write("recording/recording.txt", "");
  expectInputError([&] { readRecording(path_); }, "recording.txt", "format");
  folder_.write("recording/recording.txt", "format 1\ncolour blue\n");
  expectInputError([&] { readRecording(path_); }, "recording.txt:2", "colour");
  folder_.write("recording/recording.txt", "format 1\nprogram 0.1.0 (of today)\n");
  EXPECT_EQ(readRecording(path_).program_version, "0.1.0 (of today)");
  for (const std::string name : {"edgeslam.yaml", "camera.yaml", "decisions.txt"}) {
    const std::string content = fileContent(path_ + "/" + name);
    std::filesystem::remove(path_ + "/" + name);
    expectInputError([&] { openFrameSource(path_); }, path_ + "/" + name);
    folder_.write("recording/" + name, content);
  }
}

TEST_F(RecordingSourceTest, ARecordingWithoutFramesIsToldAndItsDecisionsAreStillRead) {
  const Recording recording = readWith("");
  EXPECT_TRUE(recording.frames.empty());
  EXPECT_FALSE(recording.decisions.complete);
  expectInputError([&] { openFrameSource(path_); }, path_, "holds no frames");
}

TEST_F(RecordingSourceTest, TheMaskIsKeptBesideTheFrames) {
  const TemporaryFolder folder;
  cv::Mat image(made_height, made_width, CV_8U, cv::Scalar(255));
  image.rowRange(0, 5).setTo(0);
  RecordingDescription description = madeDescription();
  description.camera.mask = makeCameraMask(image);
  RecordingWriter().open(folder.path("masked"), description, noLimits());
  EXPECT_TRUE(same(readMask(folder.path("masked/mask.png"))->masked, description.camera.mask->masked));
  RecordingWriter().open(folder.path("plain"), madeDescription(), noLimits());
  EXPECT_FALSE(std::filesystem::exists(folder.path("plain/mask.png")));
}

}  // namespace
}  // namespace edgeslam
