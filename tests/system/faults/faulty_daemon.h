// `edgeslam run` on frames that do not end soon, its disk failing when a test says so.
#pragma once

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
    for (const std::string& word : {EDGESLAM_PROGRAM, "run", "--source", source_.c_str()}) command.push_back(word);
    command.insert(command.end(), options.begin(), options.end());
    return std::make_unique<BackgroundProcess>(command);
  }
  // Frames go on to be told of, so many from now on.
  bool goesOn(std::size_t frames = 30) const {
    const std::size_t before = robot_->heard().states.size();
    return robot_->hears([&](const Heard& heard) { return heard.states.size() > before + frames; });
  }
  bool isRecording() const {
    const Heard heard = robot_->heard();
    return !heard.statuses.empty() && heard.statuses.back().recording;
  }

  const std::string disk_ = folder_.path("disk");
  const std::string map_ = disk_ + "/robot.map", recordings_ = disk_ + "/recordings";
  const std::string broken_ = folder_.path("broken");  // while it is there, the disk fails
  std::string source_;                                 // 80 s
};

}  // namespace edgeslam
