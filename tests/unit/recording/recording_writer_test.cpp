#include "recording/recording_writer.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "frames/folder_source.h"
#include "unit/files/resource_limit.h"
#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

class RecordingWriterTest : public TestInMemory {};

using MakeFrame = cv::Mat (*)(int);

// Writes frames and updates, with a sync after every seventh frame, until recording ends. Throws where it cannot be
// opened.
RecordingStatus writeUntilItEnds(const std::string& folder, const RecordingLimits& limits, int frames, MakeFrame make,
                                 int updates_a_third_frame = 1) {
  RecordingWriter writer;
  writer.open(folder, madeDescription(), limits);
  for (int i = 0; i < frames && writer.status().recording; ++i) {
    for (int k = 0; i % 3 == 0 && k < updates_a_third_frame; ++k) {
      writer.writeDecision({DecisionKind::update, i, 0, i * updates_a_third_frame + k, ""});
    }
    writer.writeFrame(i, madeTime(i), make(i));
    if (i % 7 == 6) writer.sync();
  }
  writer.close();
  return writer.status();
}

// Empty, or what is wrong: the first frames must be there, as made, and rgb.txt must name nothing but whole files of
// the archive.
std::string problemOfPrefix(const std::string& folder, const RecordingStatus& status, MakeFrame make) {
  const Recording recording = readRecording(folder);
  const auto count = static_cast<std::int64_t>(recording.frames.size());
  if (count > status.frames) return "more frames than were written";
  if (recording.decisions.complete) return "called complete";
  if (recording.decisions.note.empty()) return "no note";
  if (recording.decisions.updates.size() < static_cast<std::size_t>(count + 2) / 3) return "updates are missing";
  if (count > 0) {
    RecordingSource source(recording);
    for (int i = 0; i < count; ++i) {
      const std::optional<Frame> frame = source.next();
      if (!frame || frame->index != i || frame->time_ns != madeTime(i)) return "frame " + std::to_string(i);
      if (!same(frame->grey, make(i))) return "pixels of frame " + std::to_string(i) + " " + frame->problem;
    }
  }
  if (fileContent(folder + "/rgb.txt").find("rgb/") == std::string::npos) return "";
  const auto files = unpacked(fileContent(folder + "/rgb.tar"));
  std::vector<StampedFile> list = readTumImageList(folder + "/rgb.txt");
  if (fileContent(folder + "/rgb.txt").back() != '\n') list.pop_back();  // the line may be torn
  for (const StampedFile& listed : list) {
    const auto i = static_cast<int>((listed.time_ns - madeTime(0)) / (madeTime(1) - madeTime(0)));
    const auto file = files.find(fs::relative(listed.path, folder));
    if (file == files.end()) return "listed and not there: " + listed.path;
    const std::vector<unsigned char> bytes(file->second.begin(), file->second.end());
    if (!same(cv::imdecode(bytes, cv::IMREAD_GRAYSCALE), make(i))) return "listed file " + listed.path;
  }
  return "";
}

void expectReadablePrefix(const std::string& folder, const RecordingStatus& status, MakeFrame make) {
  EXPECT_EQ(problemOfPrefix(folder, status, make), "");
}

std::int64_t bytesOf(const std::string& folder) {
  std::int64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += static_cast<std::int64_t>((entry.file_size() + 4095) / 4096 * 4096);
  }
  return bytes;
}

TEST_F(RecordingWriterTest, TakesAnEmptyFolderAndNoOther) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path("empty"));
  EXPECT_TRUE(writeUntilItEnds(folder.path("empty"), noLimits(), 1, madeFrame).frames == 1);
  EXPECT_TRUE(writeUntilItEnds(folder.path("some/where/new/"), noLimits(), 1, madeFrame).frames == 1);
  folder.write("taken/file", "x");
  for (const char* name : {"taken", "taken/file", "empty", "taken/file/below"}) {
    RecordingWriter writer;
    expectInputError([&] { writer.open(folder.path(name), madeDescription()); }, folder.path(name));
    EXPECT_FALSE(writer.status().recording);
    EXPECT_FALSE(writer.writeFrame(0, 0, madeFrame(0)));
    EXPECT_FALSE(writer.sync());
  }
  EXPECT_EQ(fileContent(folder.path("taken/file")), "x");
  EXPECT_FALSE(fs::exists(folder.path("taken/rgb.tar")));
}

TEST(RecordingWriter, TellsHowItWent) {
  const TemporaryFolder folder;
  const RecordingStatus status = writeUntilItEnds(folder.path("recording"), noLimits(), 20, madeFrame);
  EXPECT_FALSE(status.recording);
  EXPECT_EQ(status.frames, 20);
  EXPECT_EQ(status.not_recorded, 0);
  EXPECT_GE(status.bytes, bytesOf(folder.path("recording")));
  EXPECT_LE(status.bytes, bytesOf(folder.path("recording")) + 6 * 4096);
  EXPECT_NE(status.message.find("ended with the run"), std::string::npos) << status.message;
  EXPECT_TRUE(readRecording(folder.path("recording")).decisions.complete);
}

TEST_F(RecordingWriterTest, WithoutCloseWhatWasWrittenStays) {
  const TemporaryFolder folder;
  {
    RecordingWriter writer;
    writer.open(folder.path("recording"), madeDescription(), noLimits());
    for (int i = 0; i < 3; ++i) writer.writeFrame(i, madeTime(i), madeFrame(i));
  }
  const Recording recording = readRecording(folder.path("recording"));
  EXPECT_EQ(recording.frames.size(), 3U);
  EXPECT_FALSE(recording.decisions.complete);
}

TEST_F(RecordingWriterTest, WhatCannotBeRecordedIsAGap) {
  const TemporaryFolder folder;
  RecordingWriter writer;
  writer.open(folder.path("recording"), madeDescription(), noLimits());
  EXPECT_TRUE(writer.writeFrame(5, madeTime(5), madeFrame(5)));
  EXPECT_FALSE(writer.writeFrame(5, madeTime(6), madeFrame(6)));
  EXPECT_FALSE(writer.writeFrame(6, madeTime(5), madeFrame(6)));
  EXPECT_FALSE(writer.writeFrame(6, -1, madeFrame(6)));
  EXPECT_FALSE(writer.writeFrame(6, madeTime(6), cv::Mat()));
  EXPECT_FALSE(writer.writeFrame(6, madeTime(6), cv::Mat(made_height, made_width, CV_8UC3)));
  EXPECT_FALSE(writer.writeFrame(6, madeTime(6), cv::Mat(made_height, made_width + 1, CV_8UC1)));
  EXPECT_FALSE(writer.writeDecision({DecisionKind::end, 0, 0, 0, ""}));
  EXPECT_TRUE(writer.writeDecision({DecisionKind::gap, 0, 0, 10, ""}));
  EXPECT_TRUE(writer.writeFrame(6, madeTime(6), madeFrame(6)));
  writer.close();
  EXPECT_EQ(writer.status().frames, 2);
  EXPECT_EQ(writer.status().not_recorded, 17);
  EXPECT_NE(writer.status().message.find("without 17 frames or decisions"), std::string::npos);
  const Recording recording = readRecording(folder.path("recording"));
  EXPECT_EQ(recording.decisions.not_recorded, 17);
  EXPECT_FALSE(recording.decisions.complete);
  ASSERT_EQ(recording.frames.size(), 2U);
  expectFramesAsMade(recording, madeFrame);
}

TEST_F(RecordingWriterTest, TheBudgetIsKept) {
  for (const std::int64_t budget : {0, 30'000, 60'000, 100'000, 101'000, 102'000, 300'000}) {
    SCOPED_TRACE(budget);
    const TemporaryFolder folder;
    const RecordingStatus status = writeUntilItEnds(folder.path("recording"), {budget, 0}, 1000, madeFrame);
    EXPECT_NE(status.message.find("budget of " + std::to_string(budget)), std::string::npos) << status.message;
    expectReadablePrefix(folder.path("recording"), status, madeFrame);
    const Recording recording = readRecording(folder.path("recording"));
    EXPECT_EQ(static_cast<std::int64_t>(recording.frames.size()), status.frames);
    EXPECT_NE(recording.decisions.note.find("budget"), std::string::npos) << recording.decisions.note;
    if (budget == 0) continue;
    EXPECT_LE(bytesOf(folder.path("recording")), budget);
    if (budget >= 100'000) {
      EXPECT_GE(bytesOf(folder.path("recording")), budget - 30'000);
    }
  }
}

TEST_F(RecordingWriterTest, SpaceForOthersIsKept) {
  const TemporaryFolder folder;
  const auto status =
      writeUntilItEnds(folder.path("recording"), {std::int64_t{1} << 60, std::int64_t{1} << 60}, 10, madeFrame);
  EXPECT_EQ(status.frames, 0);
  EXPECT_NE(status.message.find("free"), std::string::npos) << status.message;
  EXPECT_NE(readRecording(folder.path("recording")).decisions.note.find("free"), std::string::npos);
}

// Frames fail first where there are few decisions, the list of these where there are many, and the smallest limits let
// nothing begin.
TEST_F(RecordingWriterTest, AFileThatCannotGrowLeavesAReadableRecording) {
  int not_begun = 0, frames_failed = 0, lists_failed = 0;
  for (const int updates : {1, 200}) {
    for (rlim_t bytes = 0; bytes < 16'000; bytes += 241) {
      SCOPED_TRACE(bytes);
      const TemporaryFolder folder;
      const std::string path = folder.path("a/recording");
      RecordingStatus status;
      try {
        const ResourceLimit limit(RLIMIT_FSIZE, bytes);
        status = writeUntilItEnds(path, noLimits(), 200, flatFrame, updates);
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(std::strerror(EFBIG)), std::string::npos) << error.what();
        EXPECT_FALSE(fs::exists(folder.path("a")));
        ++not_begun;
        continue;
      }
      EXPECT_FALSE(status.recording);
      EXPECT_NE(status.message.find(std::strerror(EFBIG)), std::string::npos) << status.message;
      const bool frame_failed = status.message.find("rgb.tar: ") != std::string::npos;
      ++(frame_failed ? frames_failed : lists_failed);
      expectReadablePrefix(path, status, flatFrame);
    }
  }
  EXPECT_GT(not_begun, 0);
  EXPECT_GT(frames_failed, 0);
  EXPECT_GT(lists_failed, 0);
}

// Later no file is opened.
TEST_F(RecordingWriterTest, AFileThatCannotBeOpenedIsToldBeforeTheRun) {
  int not_begun = 0, begun = 0;
  const int lowest = ::dup(STDERR_FILENO);
  ::close(lowest);
  for (int more = 0; more < 9; ++more) {
    SCOPED_TRACE(more);
    const TemporaryFolder folder;
    RecordingStatus status;
    try {
      const ResourceLimit limit(RLIMIT_NOFILE, static_cast<rlim_t>(lowest + more));
      status = writeUntilItEnds(folder.path("a/recording"), noLimits(), 20, madeFrame);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(std::strerror(EMFILE)), std::string::npos) << error.what();
      EXPECT_FALSE(fs::exists(folder.path("a")));
      ++not_begun;
      continue;
    }
    EXPECT_EQ(readRecording(folder.path("a/recording")).frames.size(), 20U);
    ++begun;
  }
  EXPECT_GT(not_begun, 0);
  EXPECT_GT(begun, 0);
}

TEST_F(RecordingWriterTest, AFolderThatVanishesIsTold) {
  const TemporaryFolder folder;
  RecordingWriter writer;
  writer.open(folder.path("recording"), madeDescription(), noLimits());
  writer.writeFrame(0, madeTime(0), madeFrame(0));
  EXPECT_TRUE(writer.sync());
  fs::remove_all(folder.path("recording"));
  writer.writeFrame(1, madeTime(1), madeFrame(1));
  EXPECT_FALSE(writer.sync());
  EXPECT_NE(writer.status().message.find(folder.path("recording/rgb.tar")), std::string::npos);
  EXPECT_NE(writer.status().message.find(std::strerror(ENOENT)), std::string::npos) << writer.status().message;
}

constexpr int cannot_mount = 77;

// In a child process with mounts of its own: 0, or cannot_mount, or what `work` returns.
int withSmallDisk(const std::string& folder, const std::string& options, const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) ::_exit(cannot_mount);
    ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("tmpfs", folder.c_str(), "tmpfs", 0, options.c_str()) != 0) ::_exit(cannot_mount);
    int result = 1;
    try {
      result = work();
    } catch (const std::exception& error) {
      std::cerr << error.what() << "\n";
    }
    ::_exit(result);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

// 0, or 1 and a message where something is wrong. A disk with room for few files has some for what grows.
int fillDisk(const std::string& folder, bool only_files_are_few) {
  std::string problem, told;
  try {
    const RecordingStatus status = writeUntilItEnds(folder, noLimits(), 100, madeFrame);
    told = status.message;
    if (only_files_are_few && readRecording(folder).decisions.complete) return 0;
    problem = problemOfPrefix(folder, status, madeFrame);
  } catch (const InputError& error) {
    if (fs::exists(folder)) problem = "the folder stays";
    told = error.what();
  }
  if (problem.empty() && told.find(std::strerror(ENOSPC)) != std::string::npos) return 0;
  std::cerr << problem << "; told: " << told << "\n";
  return 1;
}

TEST_F(RecordingWriterTest, AFullDiskLeavesAReadableRecording) {
  for (int blocks = 1; blocks < 30; ++blocks) {
    for (const std::string& options :
         {"size=" + std::to_string(blocks * 4096), "nr_inodes=" + std::to_string(blocks)}) {
      SCOPED_TRACE(options);
      const TemporaryFolder disk;
      const bool only_files_are_few = options.find("inodes") != std::string::npos;
      const int result =
          withSmallDisk(disk.path(), options, [&] { return fillDisk(disk.path("a/recording"), only_files_are_few); });
      if (result == cannot_mount) GTEST_SKIP() << "no small disk can be mounted here";
      ASSERT_EQ(result, 0);
    }
  }
}

// What a power cut may do: files end anywhere after their last sync, or, on a disk that confirms too early, before.
TEST_F(RecordingWriterTest, APowerCutLeavesWhatWasSynced) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const TemporaryFolder folder;
    const int frames = 1 + static_cast<int>(random() % 25);
    const int synced = static_cast<int>(random() % static_cast<unsigned>(frames + 1));
    RecordingWriter writer;
    writer.open(folder.path("recording"), madeDescription(), noLimits());
    const std::string archive = folder.path("copy/rgb.tar");
    std::uintmax_t synced_bytes = 0;
    for (int i = 0; i < frames; ++i) {
      if (i % 3 == 0) writer.writeDecision({DecisionKind::update, i, 0, i, ""});
      writer.writeFrame(i, madeTime(i), madeFrame(i));
      if (i + 1 != synced) continue;
      writer.sync();
      synced_bytes = fs::file_size(folder.path("recording/rgb.tar"));
    }
    fs::copy(folder.path("recording"), folder.path("copy"), fs::copy_options::recursive);
    fs::resize_file(archive, synced_bytes + random() % (fs::file_size(archive) - synced_bytes + 1));
    expectReadablePrefix(folder.path("copy"), writer.status(), madeFrame);
    EXPECT_EQ(readRecording(folder.path("copy")).frames.size(), static_cast<std::size_t>(synced));

    const std::string decisions = folder.path("copy/decisions.txt");
    const std::uintmax_t cut = std::min<std::uintmax_t>(random() % 100, fs::file_size(decisions));
    fs::resize_file(decisions, fs::file_size(decisions) - cut);
    expectReadablePrefix(folder.path("copy"), writer.status(), madeFrame);
    EXPECT_GE(readRecording(folder.path("copy")).frames.size() + 3, static_cast<std::size_t>(synced));

    fs::resize_file(archive, random() % (synced_bytes + 1));
    folder.write("copy/rgb.txt", "");
    expectReadablePrefix(folder.path("copy"), writer.status(), madeFrame);
  }
}

// The program killed while it writes: what was synced is there.
TEST_F(RecordingWriterTest, AKilledProgramLeavesWhatWasSynced) {
  const TemporaryFolder folder;
  int synced_pipe[2];
  ASSERT_EQ(::pipe(synced_pipe), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    RecordingWriter writer;
    writer.open(folder.path("recording"), madeDescription(), noLimits());
    for (int i = 0;; ++i) {
      if (i % 3 == 0) writer.writeDecision({DecisionKind::update, i, 0, i, ""});
      writer.writeFrame(i, madeTime(i), madeFrame(i));
      if (i % 7 != 6) continue;
      writer.sync();
      if (::write(synced_pipe[1], "x", 1) != 1) ::_exit(1);
    }
  }
  char byte = 0;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(::read(synced_pipe[0], &byte, 1), 1);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(synced_pipe[0]);
  ::close(synced_pipe[1]);
  RecordingStatus status;
  status.frames = 1'000'000;
  expectReadablePrefix(folder.path("recording"), status, madeFrame);
  EXPECT_GE(readRecording(folder.path("recording")).frames.size(), 35U);
}

}  // namespace
}  // namespace edgeslam
