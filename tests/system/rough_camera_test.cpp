// Cameras as they are: a calibration that is roughly right, light that fails. Rolling shutters: see bad_frames.
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

TEST(RoughCamera, ACalibrationThatIsTwoPercentOff) {
  const TemporaryFolder folder;
  for (const double factor : {0.98, 1.02}) {
    const std::string name = factor < 1 ? "short" : "long";
    const std::string sequence = EditedSequence().add(place("parlour"), 0, 239).write(folder, name);
    std::string camera = fileContent(sequence + "/camera.yaml"), wrong;
    const std::regex focal("(f[xy]: *)([0-9.]+)");
    std::smatch match;
    int found = 0;
    for (; std::regex_search(camera, match, focal); camera = match.suffix(), ++found) {
      wrong += match.prefix().str() + match[1].str() + std::to_string(factor * std::stod(match[2].str()));
    }
    ASSERT_EQ(found, 2) << "fx and fy";
    folder.write(name + "/camera.yaml", wrong + camera);
    expectPosesGoOn(replayed(sequence, folder.path(name + "_result")), sequence, 0.15);
  }
}

TEST(RoughCamera, NoiseThatRisesOnTheWay) {
  const TemporaryFolder folder;
  const std::string sequence =
      EditedSequence().add(place("parlour"), 0, 119).add(place("parlour_noisy"), 120, 239).write(folder, "sequence");
  expectPosesGoOn(replayed(sequence, folder.path("result")), sequence, 0.06);
}

}  // namespace
}  // namespace edgeslam
