// A camera that bursts, changes its size in mid-stream, or whose clock goes back: what cannot be used is refused or
// counted, and the run goes on.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "dataset/recording_source.h"
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
};

// Thirty frames a second in the mean, six of them within as many milliseconds.
TEST_F(FrameTrouble, BurstsCostFramesThatAreToldAndTheRunIsRepeated) {
  EditedSequence bursts(1000, 1000);
  for (int i = 0; i + 6 <= 240; i += 6) bursts.add(parlour_, i, i + 5).wait(0.2);
  const std::string sequence = bursts.write(folder_, "bursts"), recording = folder_.path("recording");
  const Outcome live = runProgram(
      {"replay", sequence, "--realtime", "--record", recording, "--output", folder_.path("live"), "--drawings", "0"});
  ASSERT_NE(live.exit_code, 2) << live.messages;
  const Recording read = readRecording(recording);
  EXPECT_TRUE(read.decisions.complete) << read.decisions.note;
  EXPECT_GT(read.decisions.dropped.size(), 0U);
  EXPECT_EQ(read.frames.size() + read.decisions.dropped.size(), static_cast<std::size_t>(bursts.size()));
  const auto summary = nlohmann::json::parse(fileContent(folder_.path("live/summary.json")));
  EXPECT_EQ(summary["frames"]["total"].get<std::size_t>(), read.frames.size());
  const Outcome again = runProgram({"replay", recording, "--output", folder_.path("again"), "--drawings", "0"});
  EXPECT_EQ(again.exit_code, live.exit_code) << again.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(folder_.path("live") + "/" + name) == fileContent(folder_.path("again") + "/" + name))
        << name;
  }
}

TEST_F(FrameTrouble, AnotherSizeInMidStreamIsCountedAndTrackingComesBack) {
  const std::string copy = folder_.path("copy");
  std::filesystem::copy(parlour_, copy, std::filesystem::copy_options::recursive);
  constexpr std::size_t first = 200, count = 8;
  const std::vector<std::string> list = listOf(copy);
  for (std::size_t i = first; i < first + count; ++i) {
    const std::string image = copy + "/" + list.at(i).substr(list.at(i).find(' ') + 1);
    const cv::Size size = i % 2 == 0 ? cv::Size(640, 480) : cv::Size(16, 240);
    ASSERT_TRUE(cv::imwrite(image, cv::Mat(size, CV_8U, cv::Scalar(90))));
  }
  source_ = copy;
  const auto daemon = startFaulty(FaultPlan(), {"--record", recordings_});
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  ASSERT_TRUE(robot_->hears([](const Heard& heard) { return heard.statuses.back().frames_captured == 300; }));
  EXPECT_EQ(robot_->heard().statuses.back().frames_unreadable, static_cast<std::int64_t>(count));
  EXPECT_TRUE(isMeasured(robot_->heard().states.back())) << robot_->heard().states.back().reason;
  EXPECT_EQ(daemon->times("more of them are only counted"), 1) << daemon->said();
  const Recording read = readRecording(recordings_);
  EXPECT_EQ(std::count_if(read.frames.begin(), read.frames.end(), [](const auto& f) { return !f.problem.empty(); }),
            static_cast<std::ptrdiff_t>(count));
}

TEST_F(FrameTrouble, TimesThatGoBackRepeatOrChangePlacesAreRefusedBeforeTheRun) {
  const std::string copy = folder_.path("copy");
  std::filesystem::copy(parlour_, copy, std::filesystem::copy_options::recursive);
  const std::vector<std::string> list = listOf(copy);
  const auto stamp = [&](std::size_t i) { return list.at(i).substr(0, list.at(i).find(' ')); };
  const auto file = [&](std::size_t i) { return list.at(i).substr(list.at(i).find(' ')); };
  const std::vector<std::pair<std::string, std::string>> wrong{{stamp(49) + file(50), "is the same as"},
                                                               {stamp(10) + file(50), "lies before"},
                                                               {"0.5" + file(50), "lies before"}};
  for (const auto& [line, message] : wrong) {
    std::vector<std::string> lines = list;
    lines.at(50) = line;
    std::string text;
    for (const std::string& kept : lines) text += kept + "\n";
    folder_.write("copy/rgb.txt", text);
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"run", "--source", copy}, {"replay", copy, "--output", folder_.path("result")}}) {
      const Outcome outcome = runProgram(command);
      EXPECT_EQ(outcome.exit_code, 2);
      ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
      EXPECT_NE(outcome.failures()[0].find(message), std::string::npos) << outcome.messages;
      EXPECT_NE(outcome.failures()[0].find("rgb.txt:51"), std::string::npos) << outcome.messages;
    }
  }
}

}  // namespace
}  // namespace edgeslam
