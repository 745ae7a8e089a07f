// Frames that come in bursts, that are not there, of another size, or whose times go back: what cannot be used is
// refused or counted, and the run goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "recording/recording_source.h"
#include "system/faults/faulty_daemon.h"

namespace edgeslam {
namespace {

class FrameTrouble : public FaultyDaemon {
 protected:
  static std::vector<std::string> listOf(const std::string& sequence) {
    std::vector<std::string> lines;
    std::ifstream file(sequence + "/rgb.txt");
    for (std::string line; std::getline(file, line);) {
      if (line[0] != '#') lines.push_back(line);
    }
    return lines;
  }
  // Its first frames.
  std::string copyOfParlour(std::size_t frames) const {
    std::string copy = folder_.path("copy"), text;
    std::filesystem::copy(parlour_, copy, std::filesystem::copy_options::recursive);
    std::vector<std::string> list = listOf(copy);
    list.resize(frames);
    for (const std::string& line : list) text += line + "\n";
    folder_.write("copy/rgb.txt", text);
    return copy;
  }
};

// Thirty frames a second in the mean, six of them within as many milliseconds.
TEST_F(FrameTrouble, BurstsCostFramesThatAreToldAndTheRunIsRepeated) {
  EditedSequence bursts(1000, 1000);
  for (int i = 0; i + 6 <= 120; i += 6) bursts.add(parlour_, i, i + 5).wait(0.2);
  const std::string sequence = bursts.write(folder_, "bursts"), recording = folder_.path("recording");
  const std::string live = folder_.path("live"), again = folder_.path("again");
  const Outcome outcome =
      runProgram({"replay", sequence, "--realtime", "--record", recording, "--output", live, "--drawings", "0"});
  ASSERT_NE(outcome.exit_code, 2) << outcome.messages;
  const Recording read = readRecording(recording);
  if (!read.decisions.complete) {  // the recorder stands back on a loaded computer
    const std::string gaps = "without " + std::to_string(read.decisions.not_recorded) + " frames or decisions";
    EXPECT_NE((outcome.output + outcome.messages).find(gaps), std::string::npos) << read.decisions.note;
    return;
  }
  EXPECT_GT(read.decisions.dropped.size(), 0U);
  EXPECT_EQ(read.frames.size() + read.decisions.dropped.size(), static_cast<std::size_t>(bursts.size()));
  const auto summary = nlohmann::json::parse(fileContent(live + "/summary.json"));
  EXPECT_EQ(summary["frames"]["total"].get<std::size_t>(), read.frames.size());
  const Outcome repeated = runProgram({"replay", recording, "--output", again, "--drawings", "0"});
  EXPECT_EQ(repeated.exit_code, outcome.exit_code) << repeated.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(live + "/" + name) == fileContent(again + "/" + name)) << name;
  }
}

// Vanished, and of another size.
TEST_F(FrameTrouble, FramesThatCannotBeUsedAreCountedAndTrackingComesBack) {
  const std::string copy = copyOfParlour(180);
  constexpr std::size_t first = 120, count = 12;
  const std::vector<std::string> list = listOf(copy);
  for (std::size_t i = first; i < first + count; ++i) {
    const std::string image = copy + "/" + list.at(i).substr(list.at(i).find(' ') + 1);
    if (i % 3 == 0) {
      ASSERT_TRUE(std::filesystem::remove(image));
    } else {
      const cv::Size size = i % 3 == 1 ? cv::Size(640, 480) : cv::Size(16, 240);
      ASSERT_TRUE(cv::imwrite(image, cv::Mat(size, CV_8U, cv::Scalar(90))));
    }
  }
  source_ = copy;
  const auto daemon = startFaulty(FaultPlan(), {"--record", recordings_});
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  ASSERT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.frames_captured == 180; }));
  const Heard heard = robot_->heard();
  ASSERT_FALSE(heard.states.empty());
  EXPECT_TRUE(isMeasured(heard.states.back())) << heard.states.back().reason;
  EXPECT_EQ(daemon->times("more of them are only counted"), 1) << daemon->said();
  // Of a loaded computer some may have been dropped before they were looked at, or not recorded.
  const status_t& status = heard.statuses.back();
  EXPECT_LE(status.frames_unreadable, static_cast<std::int64_t>(count));
  EXPECT_GE(status.frames_unreadable + status.frames_dropped, static_cast<std::int64_t>(count));
  const Recording read = readRecording(recordings_);
  const auto unreadable = static_cast<std::int64_t>(
      std::count_if(read.frames.begin(), read.frames.end(), [](const auto& frame) { return !frame.problem.empty(); }));
  EXPECT_LE(unreadable, status.frames_unreadable);
  EXPECT_GE(unreadable + read.decisions.not_recorded, status.frames_unreadable);
}

// As for a replay (bad_input_test.cpp).
TEST_F(FrameTrouble, TimesThatGoBackOrRepeatAreRefusedBeforeTheRun) {
  const std::string copy = copyOfParlour(60);
  const std::vector<std::string> list = listOf(copy);
  const auto stamp = [&](std::size_t i) { return list.at(i).substr(0, list.at(i).find(' ')); };
  const std::string file = list.at(50).substr(list.at(50).find(' '));
  for (const auto& [time, message] : {std::pair{stamp(49), "is the same as"}, {stamp(10), "lies before"}}) {
    std::vector<std::string> lines = list;
    lines.at(50) = time + file;
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    folder_.write("copy/rgb.txt", text);
    const Outcome outcome = runProgram({"run", "--source", copy});
    EXPECT_EQ(outcome.exit_code, 2);
    ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
    EXPECT_NE(outcome.failures()[0].find(message), std::string::npos) << outcome.messages;
    EXPECT_NE(outcome.failures()[0].find("rgb.txt:51"), std::string::npos) << outcome.messages;
  }
}

}  // namespace
}  // namespace edgeslam
