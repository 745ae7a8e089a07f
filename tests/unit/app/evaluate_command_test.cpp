#include "app/evaluate_command.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

// A spiral, ten poses a second, and the same at twice the size.
struct Files {
  TemporaryFolder folder;
  std::string estimate, reference;

  Files() {
    Trajectory small, large;
    for (int i = 0; i < 40; ++i) {
      const double t = 0.1 * i;
      const Eigen::Vector3d position(std::cos(t), std::sin(t), 0.2 * t);
      small.push_back({std::llround(1e9 * t), {Eigen::Quaterniond::Identity(), position}});
      large.push_back({std::llround(1e9 * t), {Eigen::Quaterniond::Identity(), 2 * position}});
    }
    estimate = folder.write("estimate.txt", formatTrajectory(small));
    reference = folder.write("groundtruth.txt", formatTrajectory(large));
  }
};

int run(std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = -1;
  addEvaluateCommand(app, exit_code);
  arguments.insert(arguments.begin(), "evaluate");
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  app.parse(arguments);
  return exit_code;
}

TEST(EvaluateCommand, PrintsTheErrorsWithTheirUnits) {
  const Files files;
  testing::internal::CaptureStdout();
  const int exit_code = run({files.estimate, files.reference});
  const std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_EQ(exit_code, 0);
  for (const char* text : {"similarity", "scale 2.000000", "rmse", "median", " m ", "deg", "40", "100.0 %"}) {
    EXPECT_NE(printed.find(text), std::string::npos) << text << " in\n" << printed;
  }
}

TEST(EvaluateCommand, WritesTheSameFiguresAsJson) {
  const Files files;
  const std::string path = files.folder.path("figures.json");
  testing::internal::CaptureStdout();
  run({files.estimate, files.reference, "--alignment", "rigid", "--delta", "0.5", "--json", path});
  testing::internal::GetCapturedStdout();
  const nlohmann::json json = nlohmann::json::parse(fileContent(path));
  EXPECT_EQ(json["alignment"], "rigid");
  EXPECT_EQ(json["scale"], 1.0);
  EXPECT_EQ(json["absolute_error"]["pairs"], 40);
  const AbsoluteError expected =
      absoluteError(readTrajectory(files.estimate), readTrajectory(files.reference), Alignment::rigid);
  EXPECT_EQ(json["absolute_error"]["translation_m"]["rmse"].get<double>(), expected.translation.rmse);
  EXPECT_EQ(json["relative_error"]["delta_s"], 0.5);
  EXPECT_GT(json["relative_error"]["translation_m"]["rmse"].get<double>(), 0.1);
}

TEST(EvaluateCommand, TellsOfMapsThatWereNotJoined) {
  const Files files;
  const Trajectory all = readTrajectory(files.estimate);
  files.folder.write("estimate.txt", formatTrajectory({all.begin(), all.begin() + 20}));
  files.folder.write("estimate_map1.txt", formatTrajectory({all.begin() + 24, all.begin() + 34}));
  files.folder.write("estimate_map2.txt", formatTrajectory({}));
  files.folder.write("estimate_map4.txt", "no trajectory: those of a run have no gap in their numbers");
  const std::string path = files.folder.path("figures.json");
  testing::internal::CaptureStdout();
  run({files.estimate, files.reference, "--json", path});
  const std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_NE(printed.find("beside it 2 of maps that were not joined: 75.0 %"), std::string::npos) << printed;
  const nlohmann::json covered = nlohmann::json::parse(fileContent(path))["coverage"];
  EXPECT_EQ(covered["maps"], 3);
  EXPECT_EQ(covered["pose_share"], 0.5);
  EXPECT_EQ(covered["pose_share_in_any_map"], 0.75);
}

TEST(EvaluateCommand, WrongUseIsRefused) {
  const Files files;
  EXPECT_THROW(run({files.estimate}), CLI::ParseError);
  EXPECT_THROW(run({files.estimate, files.reference, "--alignment", "affine"}), CLI::ParseError);
  EXPECT_THROW(run({files.estimate, files.reference, "--tolerance", "wide"}), CLI::ParseError);
  EXPECT_THROW(run({files.estimate, files.reference, "--delta", "-1"}), InputError);
  EXPECT_THROW(run({files.estimate, files.reference, "--tolerance", "nan"}), InputError);
  EXPECT_THROW(run({files.folder.path("none"), files.reference}), InputError);
}

TEST(EvaluateCommand, AJsonFileThatCannotBeWrittenFailsBeforeAnythingIsPrinted) {
  const Files files;
  testing::internal::CaptureStdout();
  EXPECT_THROW(run({files.estimate, files.reference, "--json", files.folder.path("none/f.json")}), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace edgeslam
