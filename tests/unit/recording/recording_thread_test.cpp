#include "recording/recording_thread.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

std::shared_ptr<const FrameImages> imagesOf(const cv::Mat& grey) {
  auto images = std::make_shared<FrameImages>();
  images->pyramid.levels.push_back(grey);
  return images;
}

RecordingEntry frameEntry(int i) {
  RecordingEntry entry;
  entry.index = i;
  entry.time_ns = madeTime(i);
  entry.images = imagesOf(madeFrame(i));
  return entry;
}

RecordingEntry updateEntry(int i, int number) {
  RecordingEntry entry;
  entry.kind = DecisionKind::update;
  entry.index = i;
  entry.number = number;
  return entry;
}

// Tries again until it is taken; counts what was lost before.
int postUntilTaken(RecordingThread& thread, const RecordingEntry& entry) {
  int lost = 0;
  while (!thread.post(entry)) {
    ++lost;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return lost;
}

TEST(RecordingThread, RecordsWhatIsPosted) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {200});
  for (int i = 0; i < 60; ++i) {
    RecordingEntry entry = frameEntry(i);
    if (i == 10) {
      entry.kind = DecisionKind::dropped;
      entry.images.reset();
    }
    if (i == 20) entry = unreadableFrameEntry(i, madeTime(i), "no signal");
    if (i % 4 == 0) {
      EXPECT_TRUE(thread.post(updateEntry(i, i)));
    }
    EXPECT_TRUE(thread.post(entry));
    if (i % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  const RecordingStatus status = thread.stop();
  EXPECT_FALSE(status.recording);
  EXPECT_EQ(status.frames, 58);
  EXPECT_EQ(status.not_recorded, 0);
  const Recording recording = readRecording(folder.path("recording"));
  EXPECT_TRUE(recording.decisions.complete) << recording.decisions.note;
  EXPECT_EQ(recording.frames.size(), 59U);
  EXPECT_EQ(recording.decisions.updates.size(), 15U);
  ASSERT_EQ(recording.decisions.dropped.size(), 1U);
  EXPECT_EQ(recording.frames[19].problem, "no signal");
  expectFramesAsMade(recording, madeFrame);
}

// Frames that are made faster than they can be packed.
TEST(RecordingThread, InHasteFramesAreWrittenAsTheyAre) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {300});
  std::vector<RecordingEntry> entries;
  for (int i = 0; i < 200; ++i) {
    entries.push_back(frameEntry(i));
    entries.back().images = imagesOf(flatFrame(i));
  }
  for (const RecordingEntry& entry : entries) EXPECT_TRUE(thread.post(entry));
  EXPECT_EQ(thread.stop().frames, 200);
  const Recording recording = readRecording(folder.path("recording"));
  expectFramesAsMade(recording, flatFrame);
  int plain = 0;
  for (const RecordedFrame& frame : recording.frames) plain += frame.image->size > made_width * made_height ? 1 : 0;
  EXPECT_GT(plain, 0);
  EXPECT_LT(plain, 200) << "the last ones are packed again";
}

TEST(RecordingThread, ALongReasonIsCutOff) {
  const RecordingEntry entry = unreadableFrameEntry(1, 2, std::string(1000, 'x'));
  EXPECT_EQ(std::string(entry.reason.data()), std::string(entry.reason.size() - 1, 'x'));
}

TEST(RecordingThread, WhatAFullQueueLosesIsCountedAtItsPlace) {
  const TemporaryFolder folder;
  std::int64_t lost = 0, taken = 0;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {4});
  // Faster than any disk; then a pause, and one more.
  for (int i = 0; i < 2000; ++i) ++(thread.post(frameEntry(i)) ? taken : lost);
  ASSERT_GT(lost, 0);
  lost += postUntilTaken(thread, frameEntry(2000));
  ++taken;
  EXPECT_GE(thread.status().not_recorded, lost);
  const RecordingStatus status = thread.stop();
  EXPECT_EQ(status.not_recorded, lost);
  EXPECT_EQ(status.frames, taken);
  const Recording recording = readRecording(folder.path("recording"));
  EXPECT_EQ(recording.decisions.not_recorded, lost);
  EXPECT_FALSE(recording.decisions.complete);
  EXPECT_EQ(static_cast<std::int64_t>(recording.frames.size()), taken);
  EXPECT_EQ(recording.frames.back().index, 2000);
  expectFramesAsMade(recording, madeFrame);

  // Each gap stands where the indices jump, and is as wide.
  std::ifstream lines(folder.path("recording/decisions.txt"));
  std::string word, rest;
  std::int64_t expected = 0, value = 0;
  while (lines >> word && word != "end") {
    lines >> value;
    std::getline(lines, rest);
    if (word == "gap") expected += value;
    if (word == "frame") {
      EXPECT_TRUE(value == expected || value == 2000) << value << " " << expected;
      expected = value + 1;
    }
  }
  EXPECT_EQ(word, "end");
}

TEST(RecordingThread, WhatIsLostLastIsToldToo) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {1});
  std::int64_t lost = 0;
  int i = 0;
  while (thread.post(frameEntry(i))) ++i;
  for (int more = 0; more < 3; ++more) lost += thread.post(updateEntry(i, more)) ? 0 : 1;
  ++lost;
  EXPECT_EQ(thread.stop().not_recorded, lost);
  EXPECT_EQ(readRecording(folder.path("recording")).decisions.not_recorded, lost);
}

TEST(RecordingThread, WhatWaitsIsBoundedByTheMemoryOfItsImages) {
  const TemporaryFolder folder;
  constexpr std::int64_t bytes = made_width * made_height;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {10'000, 10 * bytes});
  std::vector<RecordingEntry> entries;
  for (int i = 0; i < 5000; ++i) entries.push_back(frameEntry(i));
  int lost = 0;
  long most_held = 0;
  for (const RecordingEntry& entry : entries) {
    lost += thread.post(entry) ? 0 : 1;
    const auto held = std::count_if(entries.begin(), entries.end(),
                                    [](const RecordingEntry& any) { return any.images.use_count() > 1; });
    most_held = std::max<long>(most_held, held);
  }
  EXPECT_GT(lost, 0);
  EXPECT_LE(most_held, 12) << "those that wait, one that is written, and one just let go";
  EXPECT_TRUE(thread.post(updateEntry(5000, 1))) << "what has no image is not refused";
  EXPECT_EQ(thread.stop().not_recorded, lost);
}

TEST(RecordingThread, SoIsWhatWaitsAsTheCameraSentIt) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {10'000, 1000});
  RecordingEntry entry;
  entry.jpeg = std::make_shared<const std::vector<unsigned char>>(600, 1);
  std::int64_t taken = 0;
  for (int i = 0; i < 5000; ++i) {
    entry.index = i;
    entry.time_ns = madeTime(i);
    taken += thread.post(entry) ? 1 : 0;
  }
  EXPECT_LT(taken, 5000);
  const RecordingStatus status = thread.stop();
  EXPECT_EQ(status.frames, taken);
  EXPECT_EQ(status.not_recorded, 5000 - taken);
  EXPECT_EQ(entry.jpeg.use_count(), 1) << "let go when it is written";
}

TEST(RecordingThread, OneImageMayWaitHoweverLarge) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits(), {10, 1});
  EXPECT_TRUE(thread.post(frameEntry(0)));
  EXPECT_EQ(thread.stop().frames, 1);
}

TEST(RecordingThread, AfterTheBudgetImagesAreLetGo) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), {60'000, 0});
  std::vector<RecordingEntry> entries;
  for (int i = 0; i < 100; ++i) {
    entries.push_back(frameEntry(i));
    postUntilTaken(thread, entries.back());
  }
  const RecordingStatus status = thread.stop();
  EXPECT_FALSE(status.recording);
  EXPECT_NE(status.message.find("budget"), std::string::npos) << status.message;
  EXPECT_LT(status.frames, 100);
  for (const RecordingEntry& entry : entries) EXPECT_EQ(entry.images.use_count(), 1);
  EXPECT_EQ(static_cast<std::int64_t>(readRecording(folder.path("recording")).frames.size()), status.frames);
}

TEST(RecordingThread, SyncsEachSecondWithoutBeingAsked) {
  const TemporaryFolder folder;
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits());
  thread.post(frameEntry(0));
  const auto start = std::chrono::steady_clock::now();
  std::size_t frames = 0;
  while (frames == 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(10)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    frames = readRecording(folder.path("recording")).frames.size();
  }
  EXPECT_EQ(frames, 1U);
}

// The nice levels of this process' threads named "recorder".
std::vector<int> niceLevels() {
  std::vector<int> levels;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    if (fileContent(task.path() / "comm") != "recorder\n") continue;
    levels.push_back(getpriority(PRIO_PROCESS, static_cast<id_t>(std::stoi(task.path().filename()))));
  }
  return levels;
}

TEST(RecordingThread, OnlyTheThreadItselfIsNice) {
  const TemporaryFolder folder;
  const int before = getpriority(PRIO_PROCESS, 0);
  RecordingThread thread(folder.path("recording"), madeDescription(), noLimits());
  for (int i = 0; i < 1000 && niceLevels() != std::vector<int>{5}; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(niceLevels(), std::vector<int>{5});
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), before);
}

TEST(RecordingThread, AFolderThatIsTakenIsToldAtOnce) {
  const TemporaryFolder folder;
  folder.write("taken/file", "x");
  expectInputError([&] { RecordingThread(folder.path("taken"), madeDescription()); }, folder.path("taken"));
}

}  // namespace
}  // namespace edgeslam
