// What a run leaves of simulated sequences. ctest makes each sequence and replays it once before these tests (see
// CMakeLists.txt); by hand: `ctest -R system.simulated`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/evaluation.h"
#include "evaluation/trajectory.h"
#include "system/program.h"
#include "system/surfaces.h"

namespace edgeslam {
namespace {

// Bounds are two to three times what was measured over three seeds (panels 0.7 to 2.0 cm, panels_textured 0.05 to
// 0.12 cm, room 0.5 to 1.4 cm; the cameras go along 2 to 3 m, some 2 m from the walls).
struct Expected {
  std::string scene;
  double error_m;
  double surface_m;  // median distance of the map's points from the true surfaces
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.scene; }

class SimulatedSequence : public ::testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(std::filesystem::exists(result("summary.json")))
        << result("summary.json") << " is missing: this test needs ctest's fixtures, which make it";
    summary_ = nlohmann::json::parse(fileContent(result("summary.json")));
  }

  static std::string sequence(const std::string& file = "") {
    return std::string(EDGESLAM_RUN_FOLDER) + "/" + GetParam().scene + (file.empty() ? "" : "/" + file);
  }
  static std::string result(const std::string& file) {
    return std::string(EDGESLAM_RUN_FOLDER) + "/" + GetParam().scene + "_result/" + file;
  }
  // Lines that hold a pose.
  static std::size_t poses(const std::string& path) { return readTrajectory(path).size(); }

  nlohmann::json summary_;
};

TEST_P(SimulatedSequence, StaysWithinTheErrorBound) {
  const nlohmann::json& errors = summary_["absolute_trajectory_error"];
  EXPECT_LT(errors["trajectory"]["rmse_m"].get<double>(), GetParam().error_m);
  // What a robot steers by: poses as they were given out at the time.
  EXPECT_LT(errors["live"]["rmse_m"].get<double>(), 2 * GetParam().error_m);
  EXPECT_LT(errors["keyframes"]["rmse_m"].get<double>(), 1.5 * GetParam().error_m);
}

TEST_P(SimulatedSequence, StartsSoonAndKeepsOn) {
  EXPECT_GE(summary_["coverage_from_first_pose"].get<double>(), 0.97);
  EXPECT_LE(summary_["first_pose_s"].get<double>(), 3.0);
  EXPECT_LE(summary_["first_live_pose_s"].get<double>(), 3.0);
  EXPECT_EQ(summary_["frames"]["unreadable"].get<int>(), 0);
  EXPECT_EQ(summary_["states"]["lost"].get<int>(), 0);
}

TEST_P(SimulatedSequence, TheMapLiesOnTheSurfaces) {
  const AbsoluteError error = absoluteError(readTrajectory(result("trajectory.txt")),
                                            readTrajectory(sequence("groundtruth.txt")), Alignment::similarity);
  const auto points = readMapPoints(result("map.ply"));
  const auto lines = summary_["map_lines"].get<std::size_t>();
  ASSERT_EQ(points.size(), summary_["map_points"].get<std::size_t>() + 2 * lines);
  EXPECT_GT(points.size(), 200U);
  EXPECT_LT(medianDistanceToSurfaces(points, error.reference_T_estimate, readSurfaces(sequence("surfaces.txt"))),
            GetParam().surface_m);
}

TEST_P(SimulatedSequence, TheFilesFitTogether) {
  EXPECT_EQ(poses(result("trajectory.txt")), summary_["frames"]["with_pose"].get<std::size_t>());
  EXPECT_EQ(poses(result("trajectory_live.txt")), summary_["frames"]["with_live_pose"].get<std::size_t>());
  EXPECT_EQ(poses(result("keyframes.txt")), summary_["keyframes"].get<std::size_t>());
  const std::string table = fileContent(result("frames.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), summary_["frames"]["total"].get<std::ptrdiff_t>() + 1);
  const std::string report = fileContent(result("report.html"));
  EXPECT_GT(report.size(), 100000U);
  EXPECT_NE(report.find("</html>"), std::string::npos);
  // One file, no network.
  for (const char* outside : {"src=\"http", "src='http", "href=\"http", "@import"}) {
    EXPECT_EQ(report.find(outside), std::string::npos) << outside;
  }
}

TEST_P(SimulatedSequence, EvaluateSaysTheSame) {
  const TemporaryFolder folder;
  const Outcome outcome = runProgram(
      {"evaluate", result("trajectory.txt"), sequence("groundtruth.txt"), "--json", folder.path("error.json")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  const auto figures = nlohmann::json::parse(fileContent(folder.path("error.json")));
  const double rmse = summary_["absolute_trajectory_error"]["trajectory"]["rmse_m"];
  EXPECT_NEAR(figures["absolute_error"]["translation_m"]["rmse"].get<double>(), rmse, 1e-6);
  EXPECT_GE(figures["coverage"]["pose_share_after_start"].get<double>(), 0.97);
}

TEST_P(SimulatedSequence, ASecondRunGivesTheSameBytes) {
  const TemporaryFolder folder;
  const Outcome outcome = runProgram({"replay", sequence(), "--output", folder.path("again")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
  for (const char* file : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    const std::string first = fileContent(result(file));
    EXPECT_FALSE(first.empty()) << file;
    EXPECT_TRUE(first == fileContent(folder.path(std::string("again/") + file))) << file << " differs";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SimulatedSequence,
                         ::testing::Values(Expected{"panels", 0.05, 0.05}, Expected{"panels_textured", 0.004, 0.02},
                                           Expected{"room", 0.04, 0.08}),
                         [](const auto& scene) { return scene.param.scene; });

}  // namespace
}  // namespace edgeslam
