#include "recording/recording_source.h"

#include <cstdlib>
#include <random>
#include <sstream>

#include "frames/folder_source.h"
#include "frames/mask_file.h"
#include "recording/open_frame_source.h"
#include "unit/image_formats/made_jpeg.h"
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

  // The first frame's line.
  std::string start() const { return whole_.substr(0, whole_.find('\n') + 1); }

  // As the program recorded it before there was an archive: frames are files in rgb/.
  void makeOld() const {
    for (const auto& [name, content] : unpacked(fileContent(path_ + "/rgb.tar"))) {
      folder_.write("recording/" + name, content);
    }
    std::filesystem::remove(path_ + "/rgb.tar");
    std::istringstream lines(whole_);
    std::string old, line;
    while (std::getline(lines, line)) {
      const Decision decision = parseDecision(*undamagedDecision(line), "");
      old += decision.kind == DecisionKind::frame
                 ? checked("frame " + std::to_string(decision.index) + " " + std::to_string(decision.time_ns))
                 : line + "\n";
    }
    folder_.write("recording/decisions.txt", old);
    folder_.write("recording/recording.txt", "format 2\nprogram 0.1.0\n");
  }

  // Of frame `index`.
  ArchivedImage placeOf(std::int64_t index) const {
    const Recording recording = readRecording(path_);
    for (const RecordedFrame& frame : recording.frames) {
      if (frame.index == index) return frame.image.value();
    }
    throw std::logic_error("no such frame");
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
TEST_F(RecordingSourceTest, UnpackedItIsATumFolderToOthers) {
  std::filesystem::remove(path_ + "/recording.txt");
  EXPECT_FALSE(isRecording(path_));
  ASSERT_EQ(std::system(("tar -x -f " + path_ + "/rgb.tar -C " + path_).c_str()), 0);
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
  for (const std::string text :
       {"frame 1 99999999999999999999", "frame 99999999999999999999 1", "frame -1 5", "frame one two", "frame 0 5",
        "frame 1 5", "dropped 0 5", "update -1 3", "update 3 x", "gap -7", "gap 4000000000000000001", "nonsense",
        "frame", "correction 1", "end of it", "unreadable 0 1 x"}) {
    SCOPED_TRACE(text);
    expectInputError([&] { readWith(start() + checked(text)); }, path_ + "/decisions.txt:2: ");
  }
  expectInputError([&] { readWith(start() + checked("update 5 1") + checked("update 4 2")); }, "decisions.txt:3: ");
  expectInputError([&] { readWith(start() + checked("end") + checked("update 5 1")); }, "decisions.txt:3: ", "follow");
  const std::string second = checked("frame 1 " + std::to_string(madeTime(1)) + " 512 9 00000000");
  expectInputError([&] { readWith(second + start()); }, "decisions.txt:2: ", "must increase");
}

TEST_F(RecordingSourceTest, HostilePlacesAreToldByFileAndLine) {
  const std::string frame = "frame 1 " + std::to_string(madeTime(1));
  const ArchivedImage first = placeOf(0);
  for (const std::string text :
       {"", " ", " 5000", " 5000 700", " 5000 700 0123456", " 5000 700 01234567 8", " 5000 0 01234567",
        " -5000 700 01234567", " 5000 70000 01234567", " 5000 4000000000000000000 01234567", " 5000 700 ghijklmn"}) {
    SCOPED_TRACE(text);
    expectInputError([&] { readWith(start() + checked(frame + text)); }, path_ + "/decisions.txt:2: ",
                     "OFFSET SIZE CHECKSUM of an image of 32 x 24 pixels in 67072 bytes at most");
  }
  const std::string inside = " " + std::to_string(first.offset + 1) + " 5 01234567";
  expectInputError([&] { readWith(start() + checked(frame + inside)); }, "decisions.txt:2: ", "must increase");
  for (const char* beyond : {" 4000000000000000000 5 01234567", " 100000 60000 01234567"}) {
    const Recording recording = readWith(start() + checked(frame + beyond));
    EXPECT_EQ(recording.frames.size(), 1U);
    EXPECT_NE(recording.decisions.note.find("rgb.tar: at byte "), std::string::npos) << recording.decisions.note;
    EXPECT_NE(recording.decisions.note.find("cut off"), std::string::npos) << recording.decisions.note;
  }
}

TEST_F(RecordingSourceTest, GapsAreCountedHoweverMany) {
  const Recording some = readWith(start() + checked("gap 3") + checked("gap 4") + checked("end"));
  EXPECT_EQ(some.decisions.not_recorded, 7);
  EXPECT_FALSE(some.decisions.complete);
  EXPECT_NE(some.decisions.note.find("7 frames or decisions"), std::string::npos);
  std::string most = start();
  for (int i = 0; i < 4; ++i) most += checked("gap 4000000000000000000");
  EXPECT_EQ(readWith(most).decisions.not_recorded, std::numeric_limits<std::int64_t>::max());
}

TEST_F(RecordingSourceTest, FramesMissingAtTheEndEndTheRecordingThere) {
  const ArchivedImage last = placeOf(9);
  std::filesystem::resize_file(path_ + "/rgb.tar", static_cast<std::uintmax_t>(last.offset + last.size - 1));
  const Recording recording = readRecording(path_);
  ASSERT_EQ(recording.frames.size(), 8U);
  EXPECT_EQ(recording.frames.back().index, 8);
  EXPECT_FALSE(recording.decisions.complete);
  const std::string place = path_ + "/rgb.tar: at byte " + std::to_string(last.offset) + ": ";
  EXPECT_NE(recording.decisions.note.find(place), std::string::npos) << recording.decisions.note;
  EXPECT_NE(recording.decisions.note.find("before frame 9"), std::string::npos);
  expectFramesAsMade(recording, madeFrame);
}

// A disk that lost what it had confirmed may give zeros in its place.
TEST_F(RecordingSourceTest, FramesOfZerosAtTheEndEndTheRecordingThere) {
  std::string archive = fileContent(path_ + "/rgb.tar");
  std::fill(archive.begin() + placeOf(10).offset + 300, archive.end(), '\0');
  folder_.write("recording/rgb.tar", archive);
  const Recording recording = readRecording(path_);
  EXPECT_EQ(recording.frames.back().index, 9);
  EXPECT_NE(recording.decisions.note.find("damaged"), std::string::npos) << recording.decisions.note;
  expectFramesAsMade(recording, madeFrame);
}

TEST_F(RecordingSourceTest, WithoutItsFramesARecordingIsRefused) {
  std::filesystem::remove(path_ + "/rgb.tar");
  expectInputError([&] { openFrameSource(path_); }, path_ + ": the recording holds no frames", "rgb.tar: no such file");
  folder_.write("recording/rgb.tar", "");
  expectInputError([&] { openFrameSource(path_); }, "holds no frames", "rgb.tar: at byte 512: the frame is cut off");
}

TEST_F(RecordingSourceTest, ASingleDamagedFrameIsAProblemAndTheNextOneIsRead) {
  std::string archive = fileContent(path_ + "/rgb.tar");
  for (const int index : {1, 4}) archive[static_cast<std::size_t>(placeOf(index).offset + 100)] ^= 1;
  const std::string place = path_ + "/rgb.tar: at byte " + std::to_string(placeOf(4).offset) + ": ";
  folder_.write("recording/rgb.tar", archive);
  RecordingSource source(readRecording(path_));
  EXPECT_EQ(source.size(), 11);
  int problems = 0;
  while (const std::optional<Frame> frame = source.next()) {
    const bool bad = frame->index == 1 || frame->index == 4 || frame->index == 7;
    EXPECT_EQ(frame->problem.empty(), !bad) << frame->problem;
    EXPECT_EQ(frame->grey.empty(), bad);
    if (frame->index == 4) {
      EXPECT_EQ(frame->problem.find(place), 0U) << frame->problem;
    }
    problems += bad ? 1 : 0;
  }
  EXPECT_EQ(problems, 3);
}

TEST_F(RecordingSourceTest, RecordingsOfEarlierFormatsAreRead) {
  const Recording recording = readRecording(path_);
  makeOld();
  for (const std::string format : {"1", "2"}) {
    folder_.write("recording/recording.txt", "format " + format + "\nprogram 0.1\n");
    const Recording old = readRecording(path_);
    EXPECT_TRUE(old.decisions.complete) << old.decisions.note;
    EXPECT_EQ(linesOf(old), linesOf(recording));
    expectPrefix(old, recording);
    expectFramesAsMade(old, madeFrame);
  }
  expectInputError([&] { readWith(whole_); }, path_ + "/decisions.txt:1: ", "format 2");
}

TEST_F(RecordingSourceTest, OfEarlierFormatsFramesMissingAtTheEndEndTheRecordingThere) {
  makeOld();
  const auto file = [this](int i) { return path_ + "/rgb/" + tumFrameName(madeTime(i)); };
  std::filesystem::remove(file(1));
  std::filesystem::remove(file(11));
  std::filesystem::resize_file(file(10), std::filesystem::file_size(file(10)) - 1);
  std::filesystem::resize_file(file(9), 0);
  const Recording recording = readRecording(path_);
  EXPECT_EQ(recording.frames.back().index, 8);
  EXPECT_EQ(recording.frames.size(), 8U);
  EXPECT_FALSE(recording.decisions.complete);
  EXPECT_NE(recording.decisions.note.find(file(9)), std::string::npos) << recording.decisions.note;
  EXPECT_NE(recording.decisions.note.find("before frame 9"), std::string::npos);
  RecordingSource source(recording);
  for (std::optional<Frame> frame = source.next(); frame; frame = source.next()) {
    EXPECT_EQ(frame->problem.empty(), frame->index != 1 && frame->index != 7) << frame->problem;
  }
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
  folder_.write("recording/recording.txt", "format 5\nprogram 9\n");
  expectInputError([&] { readRecording(path_); }, "recording.txt:1", "version 5", "version 1 to 4");
  folder_.write("recording/recording.txt", "format 3\nprogram 0.1\n");
  EXPECT_EQ(readRecording(path_).program_version, "0.1");
  folder_.write("recording/recording.txt", "");
  expectInputError([&] { readRecording(path_); }, "recording.txt", "format");
  folder_.write("recording/recording.txt", "format 1\ncolour blue\n");
  expectInputError([&] { readRecording(path_); }, "recording.txt:2", "colour");
  folder_.write("recording/recording.txt", "format 3\nprogram 0.1.0 (of today)\n");
  EXPECT_EQ(readRecording(path_).program_version, "0.1.0 (of today)");
  for (const std::string name : {"edgeslam.yaml", "camera.yaml", "decisions.txt"}) {
    const std::string content = fileContent(path_ + "/" + name);
    std::filesystem::remove(path_ + "/" + name);
    expectInputError([&] { openFrameSource(path_); }, path_ + "/" + name);
    folder_.write("recording/" + name, content);
  }
}

// As a camera sends it, though tools may take it for damaged: the pixels are those that the live run had.
TEST_F(RecordingSourceTest, AJpegOfTheCameraIsReadAsTheCameraWas) {
  const TemporaryFolder folder;
  RecordingWriter writer;
  writer.open(folder.path("sent"), madeDescription(), noLimits());
  const auto sent = [](int i) { return madeJpeg(flatFrame(40 * i)); };
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(writer.writeJpeg(i, madeTime(i), sent(i)));
  EXPECT_TRUE(writer.writeFrame(3, madeTime(3), madeFrame(3)));
  writer.close();
  const cv::Size size(made_width, made_height);
  expectFramesAsMade(readRecording(folder.path("sent")),
                     [&](int i) { return i == 3 ? madeFrame(3) : decodedAsLive(sent(i), size); });
  const auto files = unpacked(fileContent(folder.path("sent/rgb.tar")));
  ASSERT_EQ(files.size(), 4U);
  for (int i = 0; i < 3; ++i) {
    const std::vector<unsigned char> bytes = sent(i);
    EXPECT_EQ(files.at("rgb/" + formatStamp(madeTime(i)) + ".jpg"), std::string(bytes.begin(), bytes.end()));
  }
}

// Undamaged by its checksum, and yet no image: whoever wrote it.
TEST_F(RecordingSourceTest, AJpegThatIsBrokenIsAProblemOfItsFrame) {
  const TemporaryFolder folder;
  RecordingWriter writer;
  writer.open(folder.path("sent"), madeDescription(), noLimits());
  std::vector<unsigned char> cut = madeJpeg(flatFrame(9));
  cut.resize(cut.size() - 40);
  writer.writeJpeg(0, madeTime(0), cut);
  writer.writeJpeg(1, madeTime(1), madeJpeg(cv::Mat(made_height + 1, made_width, CV_8U, cv::Scalar(7))));
  writer.writeJpeg(2, madeTime(2), madeJpeg(flatFrame(9)));
  writer.close();
  RecordingSource source(readRecording(folder.path("sent")));
  EXPECT_NE(source.next()->problem.find("rgb.tar: at byte 512: a broken JPEG"), std::string::npos);
  EXPECT_NE(source.next()->problem.find("is 32 x 25 pixels"), std::string::npos);
  EXPECT_EQ(source.next()->problem, "");
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
