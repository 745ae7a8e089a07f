// Bad input, through the whole program: one clear message that names file and place, exit code 2, nothing half-written;
// single frames that cannot be read are counted and skipped. The sound sequence that is spoilt here is made by ctest
// (see CMakeLists.txt).
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "recording/recording_layout.h"
#include "system/program.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

const std::string sound_sequence = std::string(EDGESLAM_RUN_FOLDER) + "/small";

// A copy of the sound sequence, to be spoilt.
class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(fs::exists(sound_sequence + "/rgb.txt"))
        << sound_sequence << " is missing: this test needs ctest's fixtures, which make it";
    fs::copy(sound_sequence, sequence(), fs::copy_options::recursive);
  }

  std::string sequence(const std::string& file = "") const {
    return folder_.path(file.empty() ? "sequence" : "sequence/" + file);
  }
  std::string result(const std::string& file = "") const {
    return folder_.path(file.empty() ? "result" : "result/" + file);
  }

  Outcome replay(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"replay", sequence(), "--output", result(), "--drawings", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }

  // The lines of rgb.txt that name frames.
  std::vector<std::string> imageList() const {
    std::vector<std::string> lines;
    std::ifstream file(sequence("rgb.txt"));
    for (std::string line; std::getline(file, line);) {
      if (line[0] != '#') lines.push_back(line);
    }
    return lines;
  }
  void writeImageList(const std::vector<std::string>& lines) const {
    std::ofstream file(sequence("rgb.txt"));
    for (const std::string& line : lines) file << line << "\n";
  }
  std::string imagePath(std::size_t frame) const {
    const std::string line = imageList()[frame];
    return sequence(line.substr(line.find(' ') + 1));
  }

  void setCalibration(const std::string& key, const std::string& value) const {
    std::ifstream file(sequence("camera.yaml"));
    std::string text;
    for (std::string line; std::getline(file, line);) {
      text += (line.rfind(key + ":", 0) == 0 ? key + ": " + value : line) + "\n";
    }
    file.close();
    std::ofstream(sequence("camera.yaml")) << text;
  }

  // Exit code 2, one message that holds the texts, and no result.
  void expectRefusal(const Outcome& outcome, const std::vector<std::string>& texts) const {
    EXPECT_EQ(outcome.exit_code, 2);
    ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
    for (const std::string& text : texts) {
      EXPECT_NE(outcome.failures()[0].find(text), std::string::npos) << "no '" << text << "' in " << outcome.messages;
    }
    EXPECT_FALSE(fs::exists(result()));
  }

  // The run goes on without frame `frame`, and says why.
  void expectSkipped(const Outcome& outcome, std::size_t frame, const std::vector<std::string>& texts) const {
    EXPECT_EQ(outcome.exit_code, 0);
    ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
    for (const std::string& text : texts) {
      EXPECT_NE(outcome.failures()[0].find(text), std::string::npos) << "no '" << text << "' in " << outcome.messages;
    }
    EXPECT_NE(outcome.failures()[0].find("frame " + std::to_string(frame)), std::string::npos) << outcome.messages;
    const auto summary = nlohmann::json::parse(fileContent(result("summary.json")));
    EXPECT_EQ(summary["frames"]["unreadable"].get<int>(), 1);
    EXPECT_EQ(summary["frames"]["total"].get<std::size_t>(), imageList().size());
    EXPECT_GE(summary["coverage_from_first_pose"].get<double>(), 0.95);
  }

  const TemporaryFolder folder_;
};

TEST_F(BadInput, TheSoundSequenceRuns) {
  const Outcome outcome = replay();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_TRUE(outcome.failures().empty()) << outcome.messages;
  EXPECT_TRUE(fs::exists(result("summary.json")));
}

TEST_F(BadInput, AMissingFolder) {
  fs::remove_all(sequence());
  expectRefusal(replay(), {sequence(), "no such folder"});
}

TEST_F(BadInput, AnEmptyFolder) {
  fs::remove_all(sequence());
  fs::create_directory(sequence());
  expectRefusal(replay(), {sequence(), "empty", "rgb.txt"});
}

TEST_F(BadInput, AFileThatIsNoVideo) {
  const std::string file = folder_.write("notes.txt", "not a film");
  expectRefusal(runProgram({"replay", file, "--output", result()}), {file, "expected"});
  const std::string video = folder_.write("broken.mp4", "not a film either");
  fs::copy(sequence("camera.yaml"), folder_.path("camera.yaml"));
  expectRefusal(runProgram({"replay", video, "--output", result()}), {video});
}

TEST_F(BadInput, ATruncatedImageIsSkippedAndCounted) {
  const std::string image = imagePath(40);
  fs::resize_file(image, fs::file_size(image) / 2);
  expectSkipped(replay(), 40, {image});
}

TEST_F(BadInput, AMissingOrEmptyImageIsSkippedAndCounted) {
  const std::string image = imagePath(45);
  fs::remove(image);
  expectSkipped(replay(), 45, {image, "no such file"});
  std::ofstream(image).flush();
  expectSkipped(replay(), 45, {image, "empty"});
}

TEST_F(BadInput, AnImageOfAnotherSizeIsSkippedAndCounted) {
  const std::string image = imagePath(42);
  std::string other = "P5\n100 50\n255\n" + std::string(5000, 'x');
  std::ofstream(image, std::ios::binary) << other;
  expectSkipped(replay(), 42, {image, "100 x 50", "320 x 240"});
}

TEST_F(BadInput, AllImagesUnreadable) {
  for (std::size_t i = 0; i < imageList().size(); ++i) fs::resize_file(imagePath(i), 100);
  const Outcome outcome = replay();
  EXPECT_EQ(outcome.exit_code, 2);
  ASSERT_FALSE(outcome.failures().empty());
  EXPECT_NE(outcome.failures().back().find("not one frame could be read"), std::string::npos) << outcome.messages;
  EXPECT_FALSE(fs::exists(result()));
}

TEST_F(BadInput, TimeStampsThatGoBack) {
  std::vector<std::string> lines = imageList();
  std::swap(lines[10], lines[11]);
  writeImageList(lines);
  expectRefusal(replay(), {sequence("rgb.txt") + ":12", "time stamp"});
}

TEST_F(BadInput, TimeStampsThatRepeat) {
  std::vector<std::string> lines = imageList();
  lines.insert(lines.begin() + 5, lines[5]);
  writeImageList(lines);
  expectRefusal(replay(), {sequence("rgb.txt") + ":7", "the same"});
}

TEST_F(BadInput, TimeStampsThatAreNone) {
  std::vector<std::string> lines = imageList();
  for (const char* stamp : {"nan", "inf", "1e400", "soon", "-"}) {
    std::vector<std::string> wrong = lines;
    wrong[3] = std::string(stamp) + wrong[3].substr(wrong[3].find(' '));
    writeImageList(wrong);
    expectRefusal(replay(), {sequence("rgb.txt") + ":4", stamp});
  }
}

TEST_F(BadInput, AListWithoutFrames) {
  writeImageList({"# timestamp filename"});
  expectRefusal(replay(), {sequence("rgb.txt"), "no frames"});
}

TEST_F(BadInput, ACalibrationThatIsNotANumberOrImpossible) {
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"fx", "nan"}, {"fy", "-500"}, {"fx", "0"}, {"cx", "inf"}, {"k1", ".nan"}, {"width", "0"}, {"fx", "wide"}}) {
    fs::copy(sound_sequence + "/camera.yaml", sequence("camera.yaml"), fs::copy_options::overwrite_existing);
    setCalibration(key, value);
    SCOPED_TRACE(key + ": " + value);
    expectRefusal(replay(), {sequence("camera.yaml") + ":", key});
  }
}

TEST_F(BadInput, NoCalibration) {
  fs::remove(sequence("camera.yaml"));
  expectRefusal(replay(), {sequence(), "no calibration", "camera.yaml"});
}

TEST_F(BadInput, ABrokenGroundTruthIsToldBeforeTheRun) {
  std::ofstream(sequence("groundtruth.txt")) << "1000.0 0 0 0 0 0 0 1\n1000.1 0 nan 0 0 0 0 1\n";
  expectRefusal(replay(), {sequence("groundtruth.txt") + ":2"});
}

TEST_F(BadInput, AnUnknownKeyInTheConfiguration) {
  const std::string configuration = folder_.write("edgeslam.yaml", "edges:\n  sigma: 1.5\n  sigma_ration: 1.3\n");
  expectRefusal(replay({"--config", configuration}), {configuration + ":3", "sigma_ration", "sigma_ratio"});
}

TEST_F(BadInput, ImpossibleValuesInTheConfiguration) {
  for (const char* value : {"-1", ".nan", "many", "[1, 2]", "1e999"}) {
    const std::string configuration = folder_.write("edgeslam.yaml", std::string("edges:\n  sigma: ") + value + "\n");
    SCOPED_TRACE(value);
    expectRefusal(replay({"--config", configuration}), {configuration + ":2", "edges.sigma"});
  }
}

TEST_F(BadInput, AConfigurationThatIsMissingOrNoYaml) {
  expectRefusal(replay({"--config", folder_.path("missing.yaml")}), {folder_.path("missing.yaml")});
  const std::string broken = folder_.write("broken.yaml", "edges: {sigma: 1.5\ntracking: ]\n");
  expectRefusal(replay({"--config", broken}), {broken + ":"});
}

TEST_F(BadInput, AnOutputFolderThatCannotBeMade) {
  const std::string file = folder_.write("file", "a file stands here");
  const Outcome outcome = runProgram({"replay", sequence(), "--output", file + "/result", "--drawings", "0"});
  expectRefusal(outcome, {file});
  EXPECT_EQ(fileContent(file), "a file stands here");
  expectRefusal(runProgram({"replay", sequence(), "--output", "/proc/result", "--drawings", "0"}), {"/proc/result"});
}

// A disk that is full in the middle of a file, by way of the shell's limit on a file's size.
TEST_F(BadInput, ADiskThatFillsUpLeavesNothingHalfWritten) {
  const std::string limit = "trap '' XFSZ; ulimit -f 8";
  const std::vector<std::string> arguments{"replay", sequence(), "--output", result(), "--drawings", "0"};
  expectRefusal(runProgramAfter(limit, arguments), {result(), "cannot be written"});

  ASSERT_EQ(replay().exit_code, 0);
  const std::string before = fileContent(result("summary.json")), report = fileContent(result("report.html"));
  const Outcome outcome = runProgramAfter(limit, arguments);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  EXPECT_EQ(fileContent(result("summary.json")), before) << "an earlier result stays as it was";
  EXPECT_EQ(fileContent(result("report.html")), report);
  EXPECT_EQ(std::distance(fs::directory_iterator(result()), fs::directory_iterator()), 8)
      << "and nothing lies beside it";
}

// The same with a disk that is really full, where a user may mount one of his own.
TEST_F(BadInput, AFullDiskLeavesNothingHalfWritten) {
  fs::create_directory(folder_.path("disk"));
  const std::string script =
      "mount -t tmpfs -o size=256k none \"$1\" || exit 99; \"$0\" replay \"$2\" --output "
      "\"$1/result\" --drawings 0; code=$?; ls -A \"$1\" >&2; exit $code";
  const Outcome outcome = runCommand({"unshare", "--map-root-user", "--mount", "sh", "-c", script, EDGESLAM_PROGRAM,
                                      folder_.path("disk"), sequence()});
  if (outcome.exit_code == 99 || outcome.messages.rfind("unshare", 0) == 0) {
    GTEST_SKIP() << "no disk may be mounted here: " << outcome.messages;
  }
  expectRefusal(outcome, {folder_.path("disk"), "No space left"});
  EXPECT_EQ(outcome.messages.find("\nresult"), std::string::npos) << outcome.messages;
}

TEST_F(BadInput, SimulateLeavesNothingHalfWritten) {
  const std::vector<std::string> arguments{"simulate", "room", "--frames", "2", "--output", result()};
  expectRefusal(runProgramAfter("trap '' XFSZ; ulimit -f 8", arguments), {result(), "cannot be written"});
  expectRefusal(runProgram({"simulate", "moon", "--output", result()}), {"moon"});
  expectRefusal(runProgram({"simulate", "room", "--frames", "-3", "--output", result()}), {"frames"});
  expectRefusal(runProgram({"simulate", "room", "--readout", "34", "--output", result()}), {"readout", "34 ms"});
  expectRefusal(runProgram({"simulate", "room", "--frames", "2", "--output", sequence()}), {sequence(), "not empty"});
}

TEST_F(BadInput, EvaluateNamesFileAndLine) {
  const std::string truth = sequence("groundtruth.txt");
  expectRefusal(runProgram({"evaluate", folder_.path("missing.txt"), truth}), {folder_.path("missing.txt")});
  const std::string broken = folder_.write("broken.txt", "# a comment\n1 2 3\n");
  expectRefusal(runProgram({"evaluate", broken, truth}), {broken + ":2"});
  const std::string apart = folder_.write("apart.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n");
  expectRefusal(runProgram({"evaluate", apart, truth}), {"same clock"});
}

// A recording of the sequence, whose files are spoilt.
class BadRecording : public BadInput {
 protected:
  void SetUp() override {
    BadInput::SetUp();
    const Outcome live = runProgram({"replay", sequence(), "--realtime", "--record", recording(), "--output",
                                     folder_.path("live"), "--drawings", "0"});
    ASSERT_NE(live.messages.find("ended with the run"), std::string::npos) << live.messages;
    std::ifstream lines(recording("decisions.txt"));
    for (std::string line; std::getline(lines, line);) {
      lines_.push_back(line);
      if (decisionIn(line).kind == DecisionKind::frame) frame_lines_.push_back(lines_.size());
    }
    ASSERT_GE(frame_lines_.size(), 50U);
  }

  static Decision decisionIn(const std::string& line) { return parseDecision(*undamagedDecision(line), ""); }

  std::string recording(const std::string& file = "") const {
    return folder_.path(file.empty() ? "recording" : "recording/" + file);
  }

  Outcome replayRecording() const {
    return runProgram({"replay", recording(), "--output", result(), "--drawings", "0"});
  }

  // Of the recording's frame `number`, from 0: some frames of the sequence may have been dropped.
  Decision frame(std::size_t number) const { return decisionIn(lines_[frame_lines_[number] - 1]); }
  ArchivedImage imageOf(std::size_t number) const { return *archivedImageOf(frame(number)); }
  std::string lineOf(std::size_t number) const {
    return recording("decisions.txt:" + std::to_string(frame_lines_[number]) + ": ");
  }
  std::string placeOf(std::size_t number) const {
    return recording("rgb.tar: at byte " + std::to_string(imageOf(number).offset) + ": ");
  }

  // Says that the image of a frame is in another place, in a line whose checksum is right.
  void moveImage(std::size_t number, const ArchivedImage& image) const {
    std::vector<std::string> lines = lines_;
    std::string& line = lines[frame_lines_[number] - 1];
    line = formatDecision(frameDecision(frame(number).index, frame(number).time_ns, image));
    line.pop_back();
    std::ofstream file(recording("decisions.txt"));
    for (const std::string& any : lines) file << any << "\n";
  }

  std::vector<std::string> lines_;
  std::vector<std::size_t> frame_lines_;  // their numbers, from 1
};

TEST_F(BadRecording, AnImageThatCannotBeThatLargeIsRefused) {
  ArchivedImage image = imageOf(20);
  image.size = std::int64_t{1} << 60;
  moveImage(20, image);
  const Outcome outcome = replayRecording();
  expectRefusal(outcome, {lineOf(20), "bytes at most"});
  EXPECT_LT(outcome.peak_memory_kb, 200'000);
}

TEST_F(BadRecording, AnImageInAnotherOneIsRefused) {
  ArchivedImage image = imageOf(20);
  image.offset = imageOf(19).offset + 1;
  moveImage(20, image);
  expectRefusal(replayRecording(), {lineOf(20), "must increase"});
}

TEST_F(BadRecording, WithoutAnyWholeFrameItIsRefused) {
  fs::resize_file(recording("rgb.tar"), static_cast<std::uintmax_t>(imageOf(0).offset + 10));
  expectRefusal(replayRecording(), {recording("rgb.tar: at byte 512: "), "cut off", "holds no frames"});
  fs::remove(recording("rgb.tar"));
  expectRefusal(replayRecording(), {recording("rgb.tar: no such file")});
}

TEST_F(BadRecording, ItIsUsedUpToWhereItIsCutOff) {
  fs::resize_file(recording("rgb.tar"), static_cast<std::uintmax_t>(imageOf(40).offset + 10));
  const Outcome outcome = replayRecording();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.messages;
  EXPECT_NE(outcome.messages.find(placeOf(40) + "the frame is cut off"), std::string::npos) << outcome.messages;
  const std::string end = "ends before frame " + std::to_string(frame(40).index);
  EXPECT_NE(outcome.messages.find(end), std::string::npos) << outcome.messages;
}

TEST_F(BadRecording, ADamagedFrameIsToldWithItsPlaceAndSkipped) {
  std::fstream archive(recording("rgb.tar"), std::ios::in | std::ios::out | std::ios::binary);
  archive.seekp(imageOf(20).offset + 1000).put('x').put('y').put('z');
  archive.close();
  const Outcome outcome = replayRecording();
  EXPECT_EQ(outcome.exit_code, 0);
  ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  const std::string told = placeOf(20) + "the frame is damaged: its checksum is another one";
  EXPECT_NE(outcome.failures()[0].find(told), std::string::npos) << outcome.messages;
  const auto summary = nlohmann::json::parse(fileContent(result("summary.json")));
  EXPECT_EQ(summary["frames"]["unreadable"].get<int>(), 1);
}

}  // namespace
}  // namespace edgeslam
