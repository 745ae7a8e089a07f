// Cameras as they are: a calibration that is roughly right, light that fails, rows that are read one after another.
// Poses go on, and what is stated of them holds. The sequences are made by ctest (see CMakeLists.txt).
#include <gtest/gtest.h>

#include <regex>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

std::string place(const std::string& name) { return std::string(EDGESLAM_RUN_FOLDER) + "/" + name; }

void expectPosesGoOn(const ReplayedRun& result, const std::string& sequence, double largest_error_m) {
  ASSERT_EQ(result.outcome.exit_code, 0) << result.outcome.messages;
  const int last = static_cast<int>(result.states.size()) - 1, first = result.firstGood(0);
  ASSERT_GE(first, 0);
  EXPECT_LE(last - first + 1 - result.countGood(first, last), 3);
  EXPECT_EQ(*std::max_element(result.worlds.begin(), result.worlds.end()), 0);
  const Trajectory truth = readTrajectory(sequence + "/groundtruth.txt");
  EXPECT_LT(largestError(readTrajectory(result.folder + "/trajectory.txt"), truth), largest_error_m);
}

// The first so many frames of the parlour with another calibration: `change` gives the value of each of fx, fy, cx and
// cy from what it was.
template <typename Change>
std::string withWrongCalibration(int frames, const Change& change, const TemporaryFolder& folder,
                                 const std::string& name) {
  const std::string sequence = EditedSequence().add(place("parlour"), 0, frames - 1).write(folder, name);
  std::string camera = fileContent(sequence + "/camera.yaml"), wrong;
  const std::regex value("([fc][xy])(: *)([0-9.]+)");
  std::smatch match;
  int found = 0;
  for (; std::regex_search(camera, match, value); camera = match.suffix(), ++found) {
    wrong += match.prefix().str() + match[1].str() + match[2].str();
    wrong += std::to_string(change(match[1].str(), std::stod(match[3].str())));
  }
  EXPECT_EQ(found, 4) << "fx, fy, cx and cy";
  folder.write(name + "/camera.yaml", wrong + camera);
  return sequence;
}

std::string withWrongFocalLengths(double times, const TemporaryFolder& folder, const std::string& name) {
  const auto change = [&](const std::string& key, double value) { return key[0] == 'f' ? times * value : value; };
  return withWrongCalibration(240, change, folder, name);
}

TEST(RoughCamera, ACalibrationThatIsTwoPercentOff) {
  const TemporaryFolder folder;
  for (const double times : {0.98, 1.02}) {
    const std::string name = times < 1 ? "short" : "long";
    expectPosesGoOn(replayed(withWrongFocalLengths(times, folder, name), folder.path(name + "_result")),
                    place("parlour"), 0.15);
  }
}

// Its board was in the middle half of the image only: there it is right to 0.1 px, and it folds the image four fifths
// of the way to the corners.
TEST(RoughCamera, ADistortionThatFoldsTheImage) {
  const TemporaryFolder folder;
  const std::string sequence = EditedSequence().add(place("parlour"), 0, 239).write(folder, "folding");
  const std::string camera = fileContent(sequence + "/camera.yaml");
  const std::regex coefficient("k[12]: *[-0-9.]+\n");
  const std::string others = std::regex_replace(camera, coefficient, "");
  ASSERT_NE(others, camera);
  folder.write("folding/camera.yaml", others + "k1: 0.02983\nk2: 0.20721\nk3: -1.54809\n");
  const ReplayedRun result = replayed(sequence, folder.path("result"));
  EXPECT_NE(result.outcome.messages.find("the distortion of the calibration cannot be right"), std::string::npos)
      << result.outcome.messages;
  expectPosesGoOn(result, sequence, 0.15);
}

TEST(RoughCamera, NoiseThatRisesOnTheWay) {
  const TemporaryFolder folder;
  const std::string sequence =
      EditedSequence().add(place("parlour"), 0, 119).add(place("parlour_noisy"), 120, 239).write(folder, "sequence");
  expectPosesGoOn(replayed(sequence, folder.path("result")), sequence, 0.06);
}

double meanError(const ReplayedRun& result, const std::string& sequence) {
  return absoluteError(readTrajectory(result.folder + "/trajectory.txt"), readTrajectory(sequence + "/groundtruth.txt"),
                       Alignment::similarity, 0.001)
      .translation.rmse;
}

// With a threshold that should not matter the largest error varies from 0.05 to 0.155 m, and the mean from 0.4 to 0.7
// of that without the readout.
constexpr double largest_of_rolling_m = 0.18;

TEST(RoughCamera, RowsThatAreReadOneAfterAnother) {
  const TemporaryFolder folder;
  const std::string sequence = place("parlour_rolling");
  const ReplayedRun with = replayed(sequence, folder.path("with"));
  expectPosesGoOn(with, sequence, largest_of_rolling_m);
  folder.write("global.yaml", "camera: {readout: 0}\n");
  const ReplayedRun without = replayed(sequence, folder.path("without"), {"--config", folder.path("global.yaml")});
  ASSERT_EQ(without.outcome.exit_code, 0) << without.outcome.messages;
  EXPECT_LT(meanError(with, sequence), 0.7 * meanError(without, sequence));
}

TEST(RoughCamera, ARollingShutterIsFoundOnTheWay) {
  const TemporaryFolder folder;
  const std::string place_rolling = place("parlour_rolling");
  const std::string sequence = EditedSequence().add(place_rolling, 0, 239).write(folder, "sequence");
  std::string calibration = fileContent(sequence + "/camera.yaml");
  const std::size_t readout = calibration.find("readout:");
  ASSERT_NE(readout, std::string::npos);
  calibration.erase(readout, calibration.find('\n', readout) - readout + 1);
  folder.write("sequence/camera.yaml", calibration);
  folder.write("global.yaml", "camera: {readout: 0}\n");

  const ReplayedRun finds = replayed(sequence, folder.path("finds"));
  expectPosesGoOn(finds, sequence, largest_of_rolling_m);
  const ReplayedRun global = replayed(sequence, folder.path("global"), {"--config", folder.path("global.yaml")});
  ASSERT_EQ(global.outcome.exit_code, 0) << global.outcome.messages;
  EXPECT_LT(meanError(finds, sequence), 0.7 * meanError(global, sequence));
  const std::regex line("found on the way: the camera reads its rows over ([-0-9.]+) ms");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(finds.outcome.output, match, line)) << finds.outcome.output;
  EXPECT_NEAR(std::stod(match[1]), 24, 4);
  EXPECT_EQ(global.outcome.output.find("reads its rows"), std::string::npos);

  const ReplayedRun again = replayed(sequence, folder.path("again"));
  EXPECT_EQ(fileContent(again.folder + "/trajectory.txt"), fileContent(finds.folder + "/trajectory.txt"));
}

TEST(RoughCamera, AFocalLengthThatIsFarOffIsFoundOnTheWay) {
  const TemporaryFolder folder;
  const std::string sequence = withWrongFocalLengths(1.08, folder, "long");
  folder.write("as_it_is.yaml", "camera_finding: {enabled: false}\n");
  const ReplayedRun finds = replayed(sequence, folder.path("finds"));
  const ReplayedRun as_it_is = replayed(sequence, folder.path("as_it_is"), {"--config", folder.path("as_it_is.yaml")});
  ASSERT_EQ(finds.outcome.exit_code, 0) << finds.outcome.messages;
  ASSERT_EQ(as_it_is.outcome.exit_code, 0) << as_it_is.outcome.messages;
  EXPECT_LT(meanError(finds, sequence), meanError(as_it_is, sequence));
  EXPECT_NE(finds.outcome.output.find("the focal length is not that of the calibration"), std::string::npos)
      << finds.outcome.output;
}

TEST(RoughCamera, APrincipalPointThatIsOffIsFoundOnTheWay) {
  const TemporaryFolder folder;
  double true_x = 0, true_y = 0;
  const auto change = [&](const std::string& key, double value) {
    if (key == "cx") return (true_x = value) + 6;
    if (key == "cy") return (true_y = value) - 4;
    return value;
  };
  const std::string sequence = withWrongCalibration(300, change, folder, "off");
  folder.write("as_it_is.yaml", "camera_finding: {enabled: false}\n");
  const ReplayedRun finds = replayed(sequence, folder.path("finds"));
  const ReplayedRun as_it_is = replayed(sequence, folder.path("as_it_is"), {"--config", folder.path("as_it_is.yaml")});
  ASSERT_EQ(finds.outcome.exit_code, 0) << finds.outcome.messages;
  ASSERT_EQ(as_it_is.outcome.exit_code, 0) << as_it_is.outcome.messages;
  EXPECT_LT(meanError(finds, sequence), 0.5 * meanError(as_it_is, sequence));
  const std::regex line(
      "found on the way: the principal point is not that of the calibration, but cx: ([0-9.]+), "
      "cy: ([0-9.]+) pixels");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(finds.outcome.output, match, line)) << finds.outcome.output;
  EXPECT_NEAR(std::stod(match[1]), true_x, 2);
  EXPECT_NEAR(std::stod(match[2]), true_y, 2);
}

// Simulated cameras have 265 px, and distort.
TEST(RoughCamera, TheSizeOfTheCameraIsEnoughToTryIt) {
  const TemporaryFolder folder;
  const std::string configuration = folder.write("size.yaml", "camera: {width: 320, height: 240}\n");
  const ReplayedRun result = replayed(place("hall"), folder.path("result"), {"--config", configuration});
  expectPosesGoOn(result, place("hall"), 0.03);
  EXPECT_LT(meanError(result, place("hall")), 0.01);
  EXPECT_NE(result.outcome.messages.find("a focal length of 256 px is presumed (64 degrees"), std::string::npos)
      << result.outcome.messages;
  const std::regex line("the focal length is not that of the calibration, but ([0-9.]+) pixels");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(result.outcome.output, match, line)) << result.outcome.output;
  EXPECT_NEAR(std::stod(match[1]), 265.5, 4);
  const Outcome readout = runProgram({"calibrate", "--readout", place("hall"), "--config", configuration});
  EXPECT_EQ(readout.exit_code, 2);
  EXPECT_NE(readout.messages.find("its readout needs a calibration"), std::string::npos) << readout.messages;
  const ReplayedRun again = replayed(place("hall"), folder.path("again"), {"--config", configuration});
  EXPECT_EQ(fileContent(again.folder + "/trajectory.txt"), fileContent(result.folder + "/trajectory.txt"));
}

TEST(RoughCamera, TheReadoutIsFoundByWhatFitsBest) {
  const Outcome found = runProgram({"calibrate", "--readout", place("parlour_rolling")});
  ASSERT_EQ(found.exit_code, 0) << found.messages;
  const std::regex line("readout: ([-0-9.]+)   # \\[s\\], \\+- ([0-9.]+);");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(found.output, match, line)) << found.output;
  EXPECT_NEAR(std::stod(match[1]), 0.024, 0.004);
  EXPECT_LT(std::stod(match[2]), 0.004);
}

TEST(RoughCamera, AReadoutLongerThanTheTimeBetweenFramesIsRefused) {
  const TemporaryFolder folder;
  folder.write("long.yaml", "camera: {readout: 0.05}\n");
  const ReplayedRun result =
      replayed(place("parlour_rolling"), folder.path("result"), {"--config", folder.path("long.yaml")});
  EXPECT_EQ(result.outcome.exit_code, 2);
  EXPECT_NE(result.outcome.messages.find("readout is 0.05 s, but a frame comes every 0.03333 s"), std::string::npos)
      << result.outcome.messages;
}

}  // namespace
}  // namespace edgeslam
