// The disk is full, read-only or broken from some call on, at every call in turn: one message with the file and the
// system's reason, and what was complete before stays as it was.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>

#include "files/file_set.h"
#include "frames/frame_folder_writer.h"
#include "frames/frame_source.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "recording/recording_thread.h"
#include "system/faults/file_faults.h"
#include "unit/map/made_map.h"
#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

// Returns what went wrong, as the user is told it, or an empty text.
using Work = std::function<std::string(const std::string& folder)>;
using Check = std::function<void(const std::string& folder, const std::string& told)>;

struct FailedRun {
  std::string told;
  long steps = 0;
};

// In this process: failing calls leave it as it is.
FailedRun runFailing(const FaultPlan& plan, const std::string& folder, const Work& work) {
  setFaults(plan);
  FailedRun run{work(folder), faultSteps()};
  setFaults({});
  return run;
}

class FailingDisk : public TestInMemory {
 protected:
  static void failFromEachStep(const std::function<void(const std::string& folder)>& prepare, const Work& work,
                               const Check& check) {
    for (const auto& [fault, reason] :
         {std::pair(Fault::no_space, ENOSPC), std::pair(Fault::read_only, EROFS), std::pair(Fault::broken, EIO)}) {
      int failed = 0;
      bool beyond = false;
      for (long step = 1; !beyond; ++step) {
        SCOPED_TRACE(std::string(std::strerror(reason)) + " from step " + std::to_string(step) + " on");
        const TemporaryFolder room;
        fs::create_directory(room.path("disk"));
        prepare(room.path("disk"));
        FaultPlan plan;
        plan.under = room.path("disk");
        plan.fault = fault;
        plan.first = step;
        const FailedRun run = runFailing(plan, room.path("disk"), work);
        beyond = run.steps < step;
        failed += run.told.empty() ? 0 : 1;
        if (!run.told.empty()) {
          EXPECT_NE(run.told.find(std::strerror(reason)), std::string::npos) << run.told;
          EXPECT_NE(run.told.find(room.path("disk")), std::string::npos) << "no file is named: " << run.told;
        }
        EXPECT_TRUE(!beyond || run.told.empty()) << run.told;
        check(room.path("disk"), run.told);
        if (HasFailure()) return;
      }
      EXPECT_GT(failed, 0) << std::strerror(reason);
    }
  }
};

std::string messageOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(FailingDisk, TheMapBeforeStays) {
  const SavedMap earlier = test::madeMap(64, 48);
  SavedMap later = earlier;
  for (Keyframe& keyframe : later.map.keyframes) keyframe.time_ns += 1;
  failFromEachStep(
      [&](const std::string& folder) { std::ofstream(folder + "/hall.map", std::ios::binary) << encodeMap(earlier); },
      [&](const std::string& folder) {
        return messageOf([&] { saveMap(folder + "/hall.map", later.camera, later.map); });
      },
      [&](const std::string& folder, const std::string& told) {
        const std::string bytes = fileContent(folder + "/hall.map");
        EXPECT_TRUE(bytes == encodeMap(told.empty() ? later : earlier));
      });
}

TEST_F(FailingDisk, EachFileOfAResultIsWhole) {
  const std::vector<FileContent> earlier{{"a.txt", "first a\n"}, {"b.txt", "first b\n"}};
  const std::vector<FileContent> later{{"a.txt", "second a\n"}, {"b.txt", "second b\n"}, {"c.txt", "second c\n"}};
  failFromEachStep(
      [&](const std::string& folder) {
        for (const FileContent& file : earlier) std::ofstream(folder + "/" + file.name) << file.content;
      },
      [&](const std::string& folder) { return messageOf([&] { writeFileSet(folder, later); }); },
      [&](const std::string& folder, const std::string& told) {
        for (std::size_t i = 0; i < later.size(); ++i) {
          const std::string path = folder + "/" + later[i].name;
          const bool is_new = fileContent(path) == later[i].content;
          const bool is_old = i < earlier.size() ? fileContent(path) == earlier[i].content : !fs::exists(path);
          EXPECT_TRUE(is_new || (is_old && !told.empty())) << path;
        }
      });
}

TEST_F(FailingDisk, ARecordingIsReadableAsFarAsItReaches) {
  constexpr int frames = 7;
  int written = 0;
  bool opened = false;
  failFromEachStep([](const std::string&) {},
                   [&](const std::string& folder) {
                     written = 0;
                     RecordingWriter writer;
                     const std::string problem =
                         messageOf([&] { writer.open(folder + "/recording", madeDescription(), noLimits()); });
                     opened = problem.empty();
                     if (!opened) return problem;
                     for (int i = 0; i < frames; ++i) {
                       if (i % 2 == 0) writer.writeDecision({DecisionKind::update, i, 0, i, ""});
                       writer.writeFrame(i, madeTime(i), madeFrame(i));
                       if (i % 3 == 2 && writer.sync()) written = i + 1;
                     }
                     writer.close();
                     const std::string& message = writer.status().message;
                     return message.find("ended with the run") != std::string::npos ? "" : message;
                   },
                   [&](const std::string& folder, const std::string& told) {
                     if (!opened) return;
                     const Recording recording = readRecording(folder + "/recording");
                     EXPECT_GE(static_cast<int>(recording.frames.size()), told.empty() ? frames : written);
                     EXPECT_TRUE(recording.decisions.complete || !told.empty()) << recording.decisions.note;
                     EXPECT_TRUE(!recording.decisions.complete || recording.frames.size() == frames);
                     expectFramesAsMade(recording, madeFrame);
                   });
}

// Each of the three writes of a frame takes 50 ms.
TEST_F(FailingDisk, ASlowOneIsNotWaitedForAndWhatWasLeftIsTold) {
  constexpr int frames = 200;
  const TemporaryFolder room;
  auto images = std::make_shared<FrameImages>();
  images->pyramid.levels.push_back(madeFrame(0));
  RecordingThread thread(room.path("recording"), madeDescription(), noLimits());
  FaultPlan plan;
  plan.under = room.path();
  plan.fault = Fault::slow;
  setFaults(plan);
  for (int i = 0; i < frames; ++i) {
    RecordingEntry entry;
    entry.index = i;
    entry.time_ns = madeTime(i);
    entry.images = images;
    EXPECT_TRUE(thread.post(entry));
  }
  const auto start = std::chrono::steady_clock::now();
  const RecordingStatus status = thread.stop();
  setFaults({});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_GT(status.not_recorded, 0);
  EXPECT_EQ(status.frames + status.not_recorded, frames);
  EXPECT_NE(status.message.find("without " + std::to_string(status.not_recorded)), std::string::npos);
  const Recording recording = readRecording(room.path("recording"));
  EXPECT_EQ(static_cast<std::int64_t>(recording.frames.size()), status.frames);
  EXPECT_EQ(recording.decisions.not_recorded, status.not_recorded);
  EXPECT_EQ(images.use_count(), 1);
}

TEST_F(FailingDisk, FramesOfACameraAreReadableAsFarAsTheyAreListed) {
  constexpr int frames = 5;
  failFromEachStep([](const std::string&) {},
                   [](const std::string& folder) {
                     std::string told;
                     const std::string problem = messageOf([&] {
                       FrameFolderWriter writer(folder + "/frames", madeDescription().camera, "made", 0);
                       for (int i = 0; i < frames; ++i) writer.write(500'000'000LL * i, madeFrame(i));
                       told = writer.close();
                     });
                     return problem.empty() ? told : problem;
                   },
                   [](const std::string& folder, const std::string& told) {
                     int read = 0;
                     try {
                       const std::unique_ptr<FrameSource> source = openFrameSource(folder + "/frames");
                       while (const std::optional<Frame> frame = source->next()) {
                         EXPECT_TRUE(same(frame->grey, madeFrame(read++))) << frame->problem;
                       }
                     } catch (const InputError& error) {
                       EXPECT_FALSE(told.empty()) << error.what();
                     }
                     EXPECT_TRUE(read == frames || !told.empty());
                   });
}

}  // namespace
}  // namespace edgeslam
