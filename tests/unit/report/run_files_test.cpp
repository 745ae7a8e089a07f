#include "report/run_files.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "edgeslam/input_error.h"
#include "unit/report/made_run.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> run_file_names{"trajectory.txt", "trajectory_live.txt", "trajectory_odometry.txt",
                                           "frames.csv",     "keyframes.txt",       "map.ply",
                                           "summary.json",   "report.html"};

class RunFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("edgeslam-run-files-" + std::string(test->name()) + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::set<std::string> namesIn(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
  }
  static std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path folder_;
};

// Splits one CSV line as RFC 4180 says.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (inside_quotes && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[i++];
    } else if (line[i] == '"') {
      inside_quotes = !inside_quotes;
    } else if (line[i] == ',' && !inside_quotes) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

std::vector<std::vector<std::string>> tableOf(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) rows.push_back(fieldsOf(line));
  return rows;
}

std::size_t columnOf(const std::vector<std::string>& heading, const std::string& name) {
  return static_cast<std::size_t>(std::find(heading.begin(), heading.end(), name) - heading.begin());
}

TEST_F(RunFiles, allAreWrittenAndTrajectoriesReadBack) {
  const RunResult run = makeRun();
  const fs::path output = folder_ / "new" / "deeper";
  writeRunFiles(output.string(), run, describeMadeRun(), madeGroundTruth());
  EXPECT_EQ(namesIn(output), run_file_names);
  for (const char* name : {"trajectory.txt", "trajectory_live.txt"}) {
    const Trajectory trajectory = readTrajectory((output / name).string());
    ASSERT_EQ(trajectory.size(), static_cast<std::size_t>(made_frames - made_initialising_frames - 1)) << name;
    const FrameRecord& frame = run.frames[made_initialising_frames];
    EXPECT_EQ(trajectory.front().time_ns, frame.time_ns);
    EXPECT_LT((trajectory.front().world_T_camera.translation - frame.final_world_T_camera.translation).norm(), 1e-6);
  }
  const Trajectory keyframes = readTrajectory((output / "keyframes.txt").string());
  ASSERT_EQ(keyframes.size(), run.keyframes.size());
  EXPECT_EQ(contentOf(output / "keyframes.txt").front(), '#');
}

TEST_F(RunFiles, guessedPosesAreInTheTableButNotInTheLiveTrajectory) {
  RunResult run = makeRun();
  run.frames[30].state = TrackingState::predicted;
  run.frames[30].has_final_pose = false;
  writeRunFiles(folder_.string(), run, describeMadeRun(), std::nullopt);
  const std::int64_t guessed = run.frames[30].time_ns;
  for (const StampedPose& pose : readTrajectory((folder_ / "trajectory_live.txt").string()))
    EXPECT_NE(pose.time_ns, guessed);
  const auto table = tableOf(contentOf(folder_ / "frames.csv"));
  EXPECT_FALSE(table[31][columnOf(table[0], "live_x")].empty());
  EXPECT_TRUE(table[31][columnOf(table[0], "final_x")].empty());
}

TEST_F(RunFiles, frameTableHasARowAFrameAndAColumnAStage) {
  const RunResult run = makeRun();
  const auto table = tableOf(formatFrameTable(run));
  ASSERT_EQ(table.size(), run.frames.size() + 1);
  for (const auto& row : table) ASSERT_EQ(row.size(), table[0].size());
  EXPECT_EQ(table[1][columnOf(table[0], "reason")], run.frames[0].reason);
  EXPECT_EQ(table[1][columnOf(table[0], "time_s")], "1000000000.123456789");
  EXPECT_EQ(table[1][columnOf(table[0], "live_x")], "");
  EXPECT_EQ(table[1][columnOf(table[0], "mapping_ms")], "");
  const std::size_t keyframe = made_initialising_frames;
  EXPECT_EQ(table[keyframe + 1][columnOf(table[0], "keyframe")], "1");
  EXPECT_EQ(table[keyframe + 1][columnOf(table[0], "mapping_ms")], "40.000");
  EXPECT_NEAR(std::stod(table[keyframe + 1][columnOf(table[0], "sigma_rz_rad")]), 0.01, 1e-9);
}

TEST_F(RunFiles, summaryCountsTheFrames) {
  const RunResult run = makeRun();
  writeRunFiles(folder_.string(), run, describeMadeRun(), madeGroundTruth());
  const auto summary = nlohmann::json::parse(contentOf(folder_ / "summary.json"));
  EXPECT_EQ(summary["frames"]["total"], made_frames);
  EXPECT_EQ(summary["states"]["initialising"], made_initialising_frames);
  EXPECT_EQ(summary["states"]["lost"], 1);
  const double after_start = made_frames - made_initialising_frames;
  EXPECT_NEAR(summary["coverage_from_first_pose"].get<double>(), (after_start - 1) / after_start, 1e-12);
  EXPECT_NEAR(summary["first_pose_s"].get<double>(), made_initialising_frames / 30.0, 1e-3);
  EXPECT_NEAR(summary["real_time_ratio"].get<double>(), (made_frames - 1) / 30.0 / 2, 1e-3);
  EXPECT_EQ(summary["map_points"], run.map_points.size());
  EXPECT_EQ(summary["stage_times_ms"]["mapping"]["frames"], run.keyframes.size());
  EXPECT_NEAR(summary["stage_times_ms"]["total"]["max"].get<double>(), 5 + 2.1 + 40, 0.2);
  for (const char* name : {"trajectory", "live", "keyframes"}) {
    EXPECT_LT(summary["absolute_trajectory_error"][name]["rmse_m"].get<double>(), 1e-6) << name;
    EXPECT_NEAR(summary["absolute_trajectory_error"][name]["scale"].get<double>(), 0.5, 1e-6) << name;
  }
}

TEST_F(RunFiles, aRunThatNeverStartedIsWrittenToo) {
  RunResult run = makeRun();
  for (FrameRecord& frame : run.frames) {
    frame.state = TrackingState::initialising;
    frame.has_pose = frame.has_final_pose = false;
  }
  run.keyframes.clear();
  run.map_points.clear();
  writeRunFiles(folder_.string(), run, describeMadeRun(), madeGroundTruth());
  const auto summary = nlohmann::json::parse(contentOf(folder_ / "summary.json"));
  EXPECT_TRUE(summary["first_pose_s"].is_null());
  EXPECT_TRUE(summary["absolute_trajectory_error"]["trajectory"].is_null());
  writeRunFiles((folder_ / "empty").string(), RunResult(), RunDescription(), std::nullopt);
  EXPECT_EQ(namesIn(folder_ / "empty"), run_file_names);
}

TEST_F(RunFiles, equalResultsGiveEqualBytesWhateverTheTimes) {
  RunResult slower = makeRun();
  slower.wall_s = 77;
  for (FrameRecord& frame : slower.frames) frame.times.add(Stage::edges, 3);
  writeRunFiles((folder_ / "a").string(), makeRun(), describeMadeRun(), std::nullopt);
  writeRunFiles((folder_ / "b").string(), slower, describeMadeRun(), std::nullopt);
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_EQ(contentOf(folder_ / "a" / name), contentOf(folder_ / "b" / name)) << name;
  }
}

// Two frames that were given out in world 1 before it was joined to world 0, and 20 in world 2, which stayed alone.
RunResult makeRunOfSeveralWorlds() {
  RunResult run = makeRun();
  for (std::size_t i = 20; i < 22; ++i) run.frames[i].world = 1;
  for (std::size_t i = 70; i < 90; ++i) run.frames[i].world = run.frames[i].final_world = 2;
  run.keyframes[3].world = 2;
  for (std::size_t i = 0; i < 50; ++i) run.map_points[i].world = 2;
  return run;
}

TEST_F(RunFiles, eachWorldHasFilesOfItsOwn) {
  const RunResult run = makeRunOfSeveralWorlds();
  writeRunFiles(folder_.string(), run, describeMadeRun(), madeGroundTruth());
  std::set<std::string> names = run_file_names;
  names.insert({"trajectory_map1.txt", "trajectory_live_map1.txt", "keyframes_map1.txt", "map1.ply"});
  names.insert("trajectory_live_map2.txt");  // of the world that was joined: it has no final pose
  EXPECT_EQ(namesIn(folder_), names);
  const auto poses = [this](const char* name) { return readTrajectory((folder_ / name).string()); };
  const std::size_t all = made_frames - made_initialising_frames - 1;
  EXPECT_EQ(poses("trajectory.txt").size(), all - 20);
  EXPECT_EQ(poses("trajectory_live.txt").size(), all - 22);
  EXPECT_EQ(poses("trajectory_live_map2.txt").size(), 2U);
  for (const char* name : {"trajectory_map1.txt", "trajectory_live_map1.txt"}) {
    ASSERT_EQ(poses(name).size(), 20U) << name;
    EXPECT_EQ(poses(name).front().time_ns, run.frames[70].time_ns) << name;
  }
  EXPECT_EQ(poses("keyframes_map1.txt").size(), 1U);
  EXPECT_EQ(poses("keyframes.txt").size(), run.keyframes.size() - 1);
  EXPECT_NE(contentOf(folder_ / "map1.ply").find("element vertex 50\n"), std::string::npos);
  EXPECT_NE(contentOf(folder_ / "map.ply").find("element vertex " + std::to_string(run.map_points.size() - 50) + "\n"),
            std::string::npos);
}

TEST_F(RunFiles, theMainWorldNeedNotBeTheFirst) {
  RunResult run = makeRunOfSeveralWorlds();
  run.main_world = 2;
  writeRunFiles(folder_.string(), run, describeMadeRun(), std::nullopt);
  EXPECT_EQ(readTrajectory((folder_ / "trajectory.txt").string()).size(), 20U);
  EXPECT_EQ(readTrajectory((folder_ / "trajectory_map1.txt").string()).front().time_ns,
            run.frames[made_initialising_frames].time_ns);
}

TEST_F(RunFiles, filesOfWorldsOfAnEarlierRunDoNotStay) {
  for (const char* name : {"trajectory_map3.txt", "trajectory_live_map12.txt", "keyframes_map1.txt", "map2.ply"}) {
    std::ofstream(folder_ / name) << "of an earlier run";
  }
  std::set<std::string> names = run_file_names;
  for (const char* name : {"trajectory_map.txt", "map.ply.old", "trajectory_map1.txt.bak", "map0.ply", "mapb.ply"}) {
    std::ofstream(folder_ / name) << "of somebody else";
    names.insert(name);
  }
  fs::create_directory(folder_ / "map7.ply");
  names.insert("map7.ply");
  writeRunFiles(folder_.string(), makeRun(), describeMadeRun(), std::nullopt);
  EXPECT_EQ(namesIn(folder_), names);
}

TEST_F(RunFiles, frameTableTellsWorldsAndNoise) {
  RunResult run = makeRunOfSeveralWorlds();
  run.frames[20].noise_factor = 2.34567;
  const auto table = tableOf(formatFrameTable(run));
  const auto field = [&](std::size_t frame, const char* name) { return table[frame + 1][columnOf(table[0], name)]; };
  EXPECT_EQ(field(0, "live_world"), "");
  EXPECT_EQ(field(0, "final_world"), "");
  EXPECT_EQ(field(20, "live_world"), "1");
  EXPECT_EQ(field(20, "final_world"), "0");
  EXPECT_EQ(field(70, "final_world"), "2");
  EXPECT_EQ(field(20, "noise_factor"), "2.35");
  EXPECT_EQ(field(21, "noise_factor"), "1");
}

TEST_F(RunFiles, summaryIsOfTheMainWorldAndTellsTheOthers) {
  const RunResult run = makeRunOfSeveralWorlds();
  writeRunFiles(folder_.string(), run, describeMadeRun(), madeGroundTruth());
  const auto summary = nlohmann::json::parse(contentOf(folder_ / "summary.json"));
  const int poses = made_frames - made_initialising_frames - 1 - 20;
  EXPECT_EQ(summary["frames"]["with_pose"], poses);
  EXPECT_EQ(summary["frames"]["with_live_pose"], poses - 2);
  EXPECT_NEAR(summary["coverage_from_first_pose"].get<double>(), poses / 110.0, 1e-12);
  EXPECT_EQ(summary["absolute_trajectory_error"]["trajectory"]["pairs"], poses);
  EXPECT_EQ(summary["keyframes"], run.keyframes.size() - 1);
  EXPECT_EQ(summary["map_points"], run.map_points.size() - 50);
  ASSERT_EQ(summary["worlds"].size(), 2U);
  EXPECT_EQ(summary["worlds"][0]["frames_with_pose"], poses);
  EXPECT_EQ(summary["worlds"][1]["world"], 2);
  EXPECT_EQ(summary["worlds"][1]["frames_with_pose"], 20);
  EXPECT_EQ(summary["worlds"][1]["keyframes"], 1);
  EXPECT_NEAR(summary["worlds"][1]["first_pose_s"].get<double>(), 70 / 30.0, 1e-3);
  EXPECT_EQ(summary["recording_quality"], "");
}

TEST_F(RunFiles, mapHoldsEveryPoint) {
  const RunResult run = makeRun();
  writeRunFiles(folder_.string(), run, describeMadeRun(), std::nullopt);
  EXPECT_NE(contentOf(folder_ / "map.ply").find("element vertex " + std::to_string(run.map_points.size()) + "\n"),
            std::string::npos);
}

TEST_F(RunFiles, aFolderThatCannotBeMadeIsToldByName) {
  std::ofstream(folder_ / "file") << "not a folder";
  const std::string output = (folder_ / "file" / "output").string();
  try {
    writeRunFiles(output, makeRun(), describeMadeRun(), std::nullopt);
    FAIL() << "a folder below a file was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(output), std::string::npos) << error.what();
  }
  EXPECT_EQ(namesIn(folder_), std::set<std::string>{"file"});
}

TEST_F(RunFiles, whereOneFileCannotBeWrittenNoneIs) {
  fs::create_directories(folder_ / "out" / "report.html");
  EXPECT_THROW(writeRunFiles((folder_ / "out").string(), makeRun(), describeMadeRun(), std::nullopt), InputError);
  EXPECT_EQ(namesIn(folder_ / "out"), std::set<std::string>{"report.html"});
}

// The kernel's limit on a file's size stands in for a full disk: the report, the largest and last file, is cut off.
TEST_F(RunFiles, aDiskThatFillsUpLeavesNothingHalfWritten) {
  std::ofstream(folder_ / "trajectory.txt") << "of an earlier run";
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{200000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(writeRunFiles(folder_.string(), makeRun(), describeMadeRun(), std::nullopt), InputError);
  EXPECT_THROW(writeRunFiles((folder_ / "new").string(), makeRun(), describeMadeRun(), std::nullopt), InputError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(namesIn(folder_), std::set<std::string>{"trajectory.txt"});
  EXPECT_EQ(contentOf(folder_ / "trajectory.txt"), "of an earlier run");
}

}  // namespace
}  // namespace edgeslam
