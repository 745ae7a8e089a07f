// The power goes at every call that changes a file, and in the middle of each that writes: what was complete before is
// there and readable after, also where the machine loses all that the disk had not confirmed.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "files/file_set.h"
#include "frames/frame_folder_writer.h"
#include "frames/frame_source.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "system/faults/confirmed_disk.h"
#include "system/faults/file_faults.h"
#include "unit/map/made_map.h"
#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

// Work that says how far it has come: `confirm` is called with each thing that must be there from then on.
using Confirm = std::function<void()>;
using Work = std::function<void(const std::string& folder, const Confirm& confirm)>;
using Check = std::function<void(const std::string& folder, int confirmed)>;

struct CutRun {
  bool ended = false;  // by itself, the step being beyond the last one
  int confirmed = 0;
};

// `work` in a process of its own.
CutRun runCut(const FaultPlan& plan, const std::string& folder, const Work& work) {
  int confirmations[2];
  if (::pipe(confirmations) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    setFaults(plan);
    work(folder, [&] {
      if (::write(confirmations[1], "x", 1) != 1) ::_exit(1);
    });
    ::_exit(0);
  }
  ::close(confirmations[1]);
  CutRun run;
  for (char byte = 0; ::read(confirmations[0], &byte, 1) == 1;) ++run.confirmed;
  ::close(confirmations[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  run.ended = WIFEXITED(status);
  if (run.ended) {
    EXPECT_EQ(WEXITSTATUS(status), 0);
  } else {
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
  }
  return run;
}

class PowerCut : public TestInMemory {
 protected:
  // Cuts `work` at each step, before and within it; `check` sees what is left for each kind of loss. Returns the steps.
  static long cutAtEachStep(const std::function<void(const std::string& folder)>& prepare, const Work& work,
                            const Check& check) {
    long step = 1;
    for (bool ended = false; !ended; ++step) {
      for (const Fault fault : {Fault::cut_before, Fault::cut_within}) {
        const TemporaryFolder room;
        const std::string disk = room.path("disk"), before = room.path("before"), after = room.path("after");
        fs::create_directory(disk);
        prepare(disk);
        fs::copy(disk, before, fs::copy_options::recursive);
        const FaultPlan plan{disk, fault, step, "", room.path("log")};
        const CutRun run = runCut(plan, disk, work);
        ended = run.ended;
        fs::rename(disk, after);
        for (const Loss loss : {Loss::nothing, Loss::content, Loss::all_it_could}) {
          SCOPED_TRACE("step " + std::to_string(step) + (fault == Fault::cut_before ? " before" : " within") +
                       ", loss " + std::to_string(static_cast<int>(loss)));
          fs::remove_all(disk);
          fs::copy(after, disk, fs::copy_options::recursive);
          lose(loss, disk, plan.log, before);
          check(disk, run.confirmed);
          if (HasFailure()) return step;
        }
      }
    }
    RecordProperty("steps", static_cast<int>(step - 2));
    return step - 2;
  }
};

std::size_t filesIn(const std::string& folder) {
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) files += entry.is_regular_file() ? 1 : 0;
  return files;
}

TEST_F(PowerCut, TheMapIsTheOneBeforeOrTheNewOne) {
  const SavedMap earlier = test::madeMap(64, 48);
  SavedMap later = earlier;
  later.map.points.erase(std::prev(later.map.points.end()));
  for (Keyframe& keyframe : later.map.keyframes) keyframe.time_ns += 1;
  const std::string earlier_bytes = encodeMap(earlier), later_bytes = encodeMap(later);
  ASSERT_NE(earlier_bytes, later_bytes);
  for (const bool with_earlier : {true, false}) {
    const long steps = cutAtEachStep(
        [&](const std::string& folder) {
          if (with_earlier) std::ofstream(folder + "/hall.map", std::ios::binary) << earlier_bytes;
        },
        [&](const std::string& folder, const Confirm& confirm) {
          saveMap(folder + "/hall.map", later.camera, later.map);
          confirm();
        },
        [&](const std::string& folder, int confirmed) {
          const std::string path = folder + "/hall.map";
          if (!with_earlier && !fs::exists(path)) {
            EXPECT_EQ(confirmed, 0);
          } else {
            EXPECT_FALSE(loadMap(path, later.camera).points.empty());
            const std::string bytes = fileContent(path);
            EXPECT_TRUE(bytes == later_bytes || (with_earlier && confirmed == 0 && bytes == earlier_bytes));
          }
          saveMap(path, later.camera, later.map);
          EXPECT_EQ(filesIn(folder), 1U) << "what a cut left behind is gone with the next map";
        });
    EXPECT_GE(steps, 6) << "made, written, synced, closed, renamed, folder synced";
  }
}

TEST_F(PowerCut, EachFileOfAResultIsTheOneBeforeOrTheNewOne) {
  const std::vector<FileContent> earlier{{"a.txt", "first a\n"}, {"b.txt", "first b\n"}};
  const std::vector<FileContent> later{{"a.txt", "second a\n"}, {"b.txt", "second b\n"}, {"c.txt", "second c\n"}};
  const long steps = cutAtEachStep(
      [&](const std::string& folder) {
        for (const FileContent& file : earlier) std::ofstream(folder + "/" + file.name) << file.content;
      },
      [&](const std::string& folder, const Confirm& confirm) {
        writeFileSet(folder, later);
        confirm();
      },
      [&](const std::string& folder, int confirmed) {
        for (std::size_t i = 0; i < later.size(); ++i) {
          const std::string path = folder + "/" + later[i].name;
          const bool is_new = fileContent(path) == later[i].content;
          const bool is_old = i < earlier.size() ? fileContent(path) == earlier[i].content : !fs::exists(path);
          EXPECT_TRUE(is_new || (is_old && confirmed == 0)) << path << ": " << fileContent(path);
        }
        writeFileSet(folder, later);
        EXPECT_EQ(filesIn(folder), later.size()) << "what a cut left behind is gone with the next result";
      });
  EXPECT_GT(steps, 15);
}

constexpr int recorded_frames = 7, frames_a_sync = 3;

// Confirms the opening, each sync and the end.
void recordSomeFrames(const std::string& folder, const Confirm& confirm) {
  RecordingWriter writer;
  writer.open(folder + "/run/recording", madeDescription(), noLimits());
  confirm();
  for (int i = 0; i < recorded_frames; ++i) {
    if (i % 2 == 0) writer.writeDecision({DecisionKind::update, i, 0, i, ""});
    writer.writeFrame(i, madeTime(i), madeFrame(i));
    if (i % frames_a_sync != frames_a_sync - 1) continue;
    writer.sync();
    confirm();
  }
  writer.close();
  confirm();
}

void checkSomeFrames(const std::string& folder, int confirmed) {
  constexpr int syncs = recorded_frames / frames_a_sync, all = 1 + syncs + 1;
  Recording recording;
  try {
    recording = readRecording(folder + "/run/recording");
  } catch (const InputError& error) {
    EXPECT_EQ(confirmed, 0) << error.what();
    return;
  }
  const int frames = static_cast<int>(recording.frames.size());
  const int synced = confirmed == all ? recorded_frames : std::max(0, confirmed - 1) * frames_a_sync;
  EXPECT_GE(frames, synced);
  EXPECT_LE(frames, recorded_frames);
  EXPECT_EQ(recording.decisions.note.empty(), recording.decisions.complete);
  EXPECT_TRUE(recording.decisions.complete || confirmed < all) << recording.decisions.note;
  EXPECT_TRUE(!recording.decisions.complete || frames == recorded_frames);
  EXPECT_GE(static_cast<int>(recording.decisions.updates.size()), (frames + 1) / 2);
  expectFramesAsMade(recording, madeFrame);
}

TEST_F(PowerCut, ARecordingReachesToTheLastSyncAndSaysThatItWasNotEnded) {
  EXPECT_GT(cutAtEachStep([](const std::string&) {}, recordSomeFrames, checkSomeFrames), 50);
}

// `edgeslam record`: of frames 0.5 s apart each third one makes the disk confirm those before and itself.
TEST_F(PowerCut, FramesOfACameraAreThereUpToTheLastSync) {
  const long steps = cutAtEachStep([](const std::string&) {},
                                   [](const std::string& folder, const Confirm& confirm) {
                                     FrameFolderWriter writer(folder + "/frames", madeDescription().camera, "made", 0);
                                     for (int i = 0; i < recorded_frames; ++i) {
                                       if (!writer.write(500'000'000LL * i, madeFrame(i)).empty()) ::_exit(1);
                                       if (i % 2 == 0) confirm();
                                     }
                                     writer.close();
                                     confirm();
                                   },
                                   [](const std::string& folder, int confirmed) {
                                     const int synced =
                                         confirmed == 0 ? 0 : std::min(2 * confirmed - 1, recorded_frames);
                                     int frames = 0;
                                     try {
                                       const std::unique_ptr<FrameSource> source = openFrameSource(folder + "/frames");
                                       while (const std::optional<Frame> frame = source->next()) {
                                         if (!frame->problem.empty())
                                           break;  // the last line was torn, and names no file
                                         EXPECT_TRUE(same(frame->grey, madeFrame(frames)));
                                         ++frames;
                                       }
                                       EXPECT_LE(source->size(), frames + 1);
                                     } catch (const InputError& error) {
                                       EXPECT_EQ(confirmed, 0) << error.what();
                                     }
                                     EXPECT_GE(frames, synced);
                                   });
  EXPECT_GT(steps, 20);
}

}  // namespace
}  // namespace edgeslam
