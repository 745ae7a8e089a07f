// `edgeslam run` on frames that do not end soon, its disk failing when a test says so.
#pragma once

#include "recording/recording_source.h"
#include "system/daemon/daemon_fixture.h"
#include "system/edited_sequence.h"
#include "system/faults/file_faults.h"

namespace edgeslam {

class FaultyDaemon : public DaemonTest {
 protected:
  void SetUp() override {
    DaemonTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    std::filesystem::create_directory(disk_);
    EditedSequence there_and_back;
    for (int i = 0; i < 4; ++i) there_and_back.add(parlour_, 0, 299).add(parlour_, 298, 1);
    source_ = there_and_back.write(folder_, "source");
  }

  std::unique_ptr<BackgroundProcess> startFaulty(const FaultPlan& plan, const Options& options) {
    Options command{"env"};
    for (const std::string& variable : faultEnvironment(EDGESLAM_FILE_FAULTS, plan)) command.push_back(variable);
    for (const char* word : {EDGESLAM_PROGRAM, "run", "--source", source_.c_str()}) command.emplace_back(word);
    command.insert(command.end(), options.begin(), options.end());
    return std::make_unique<BackgroundProcess>(command);
  }
  // Frames go on to be told of, so many from now on.
  bool goesOn(std::size_t frames = 30) const {
    const std::size_t before = robot_->heard().states.size();
    return robot_->hears([&](const Heard& heard) { return heard.states.size() > before + frames; });
  }
  // Between the time stamps of frames of which the robot was told, from the one to the other state.
  double longestGap_ms(std::size_t first, std::size_t end) const {
    const std::vector<state_t> states = robot_->heard().states;
    std::int64_t longest_us = 0;
    for (std::size_t i = first + 1; i < end; ++i) {
      longest_us = std::max(longest_us, states[i].utime - states[i - 1].utime);
    }
    return 1e-3 * static_cast<double>(longest_us);
  }
  // A status to come does.
  bool tellsRecording(bool recording) const {
    const std::size_t before = robot_->heard().statuses.size();
    return robot_->hears([&](const Heard& heard) {
      return heard.statuses.size() > before && heard.statuses.back().recording == recording;
    });
  }
  // So many frames that the disk has confirmed, of a recording that goes on.
  static bool hasRecorded(const std::string& recording, std::size_t frames) {
    return comesTrue([&] { return readRecording(recording).frames.size() >= frames; });
  }

  const std::string disk_ = folder_.path("disk");
  const std::string map_ = disk_ + "/robot.map", recordings_ = disk_ + "/recordings";
  const std::string broken_ = folder_.path("broken");  // while it is there, the disk fails
  std::string source_;                                 // 80 s
};

}  // namespace edgeslam
