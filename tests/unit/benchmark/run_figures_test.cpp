#include "benchmark/run_figures.h"

#include <gtest/gtest.h>

#include "unit/benchmark/made_run_folder.h"

namespace edgeslam {
namespace {

using nlohmann::json;

TEST(RunFigures, areThoseOfTheRun) {
  const TemporaryFolder folder;
  RunResult run = makeRun();
  run.recoveries = 3, run.relocalisations = 2, run.dropped_frames = 7;
  ClosedLoop loop;
  loop.frame_index = 90, loop.how = "by its looks";
  for (const KeyframeRecord& keyframe : run.keyframes)
    loop.after.push_back({keyframe.time_ns, keyframe.world_T_camera});
  loop.before = loop.after;
  loop.before.back().world_T_camera.translation.x() += 1;
  run.closed_loops.push_back(loop);
  const RunSummary expected = summarise(run, madeGroundTruth());
  const RunFigures figures = readRunFigures(writeMadeRun(folder, "run", run));
  EXPECT_EQ(figures.sequence, "helix");
  EXPECT_EQ(figures.input, "/recordings/helix");
  EXPECT_EQ(figures.program_version, "1.2.3");
  EXPECT_EQ(figures.configuration, describeMadeRun().configuration);
  EXPECT_EQ(figures.frames, made_frames);
  EXPECT_EQ(figures.with_pose, expected.final_poses);
  EXPECT_EQ(figures.dropped, 7);
  EXPECT_EQ(figures.states.at("initialising"), made_initialising_frames);
  EXPECT_DOUBLE_EQ(figures.coverage, expected.coverage);
  EXPECT_DOUBLE_EQ(*figures.first_pose_s, *expected.first_pose_s);
  EXPECT_EQ(figures.recoveries, 3);
  EXPECT_EQ(figures.relocalisations, 2);
  EXPECT_DOUBLE_EQ(figures.trajectory->rmse_m, expected.errors.trajectory->translation.rmse);
  EXPECT_NEAR(figures.trajectory->reference_T_world->scale, 0.5, 1e-6);
  ASSERT_EQ(figures.loops.size(), 1U);
  EXPECT_EQ(figures.loops[0].how, "by its looks");
  EXPECT_GT(figures.loops[0].before->rmse_m, figures.loops[0].after->rmse_m);
  ASSERT_NE(stageOf(figures, "tracking"), nullptr);
  EXPECT_GT(stageOf(figures, "tracking")->percentile_99, 6);
  EXPECT_EQ(stageOf(figures, "no stage"), nullptr);
}

TEST(RunFigures, areOfTheMainWorldAndCountTheOthers) {
  const TemporaryFolder folder;
  RunResult run = makeRun();
  for (std::size_t i = 100; i < 120; ++i) run.frames[i].final_world = 1;
  const RunFigures figures = readRunFigures(writeMadeRun(folder, "run", run));
  EXPECT_EQ(figures.worlds, 2);
  EXPECT_EQ(figures.with_pose, 89);
  EXPECT_DOUBLE_EQ(posedShare(figures), 89.0 / made_frames);
  EXPECT_DOUBLE_EQ(posedShareInAnyWorld(figures), 109.0 / made_frames);
  EXPECT_EQ(figures.trajectory->pairs, 89);
}

TEST(RunFigures, aSummaryWithoutWorldsHasOne) {
  const TemporaryFolder folder;
  const std::string run = writeMadeRun(folder, "run", makeRun());
  changeSummary(run, [](json& summary) { summary.erase("worlds"); });
  const RunFigures figures = readRunFigures(run);
  EXPECT_EQ(figures.worlds, 1);
  EXPECT_EQ(figures.with_pose_in_any_world, figures.with_pose);
}

TEST(RunFigures, theAlignmentTakesTheRunToTheGroundTruth) {
  const TemporaryFolder folder;
  const RunResult run = makeRun();
  const RunFigures figures = readRunFigures(writeMadeRun(folder, "run", run));
  const Trajectory truth = madeGroundTruth();
  for (const std::size_t i : {20U, 50U, 110U}) {
    const Eigen::Vector3d aligned =
        *figures.trajectory->reference_T_world * run.frames[i].final_world_T_camera.translation;
    EXPECT_LT((aligned - truth[i].world_T_camera.translation).norm(), 1e-6);
  }
}

TEST(RunFigures, withoutGroundTruthThereIsNoError) {
  const TemporaryFolder folder;
  const RunFigures figures = readRunFigures(writeMadeRun(folder, "run", makeRun(), describeMadeRun(), std::nullopt));
  EXPECT_FALSE(figures.has_ground_truth);
  EXPECT_FALSE(figures.trajectory);
}

TEST(RunFigures, aSummaryWithoutTheAlignmentIsReadAllTheSame) {
  const TemporaryFolder folder;
  const std::string run = writeMadeRun(folder, "run", makeRun());
  changeSummary(run, [](json& summary) { summary["absolute_trajectory_error"]["trajectory"].erase("rotation_wxyz"); });
  EXPECT_FALSE(readRunFigures(run).trajectory->reference_T_world);
}

TEST(RunFigures, everyKeyIsMissedByName) {
  const TemporaryFolder folder;
  const std::string run = writeMadeRun(folder, "run", makeRun());
  const json whole = summaryIn(run);
  for (const std::string key :
       {"sequence", "input", "frames", "states", "coverage_from_first_pose", "keyframes", "recoveries", "closed_loops",
        "absolute_trajectory_error", "stage_times_ms", "recording_s", "real_time_ratio", "versions", "configuration"}) {
    changeSummary(run, [&](json& summary) { summary = whole, summary.erase(key); });
    expectInputError([&] { readRunFigures(run); }, "summary.json", key, "missing");
    changeSummary(run, [&](json& summary) { summary = whole, summary[key] = json::array({"odd"}); });
    expectInputError([&] { readRunFigures(run); }, "summary.json", key, "expected");
  }
}

TEST(RunFigures, impossibleValuesAreToldWithTheirKey) {
  const TemporaryFolder folder;
  const std::string run = writeMadeRun(folder, "run", makeRun());
  const json whole = summaryIn(run);
  const auto refused = [&](const std::string& pointer, const json& value, const std::string& key) {
    changeSummary(run, [&](json& summary) { summary = whole, summary[json::json_pointer(pointer)] = value; });
    expectInputError([&] { readRunFigures(run); }, "summary.json", key, "expected");
  };
  refused("/frames/total", -1, "frames.total");
  refused("/frames/total", 1e300, "frames.total");
  refused("/frames/total", 18446744073709551615U, "frames.total");
  refused("/frames/total", "120", "frames.total");
  refused("/worlds", json({1}), "worlds[0]");
  refused("/worlds/0/frames_with_pose", made_frames + 1, "frames_with_pose");
  refused("/states/tracking", 1000000, "states.tracking");
  refused("/coverage_from_first_pose", 1.5, "coverage_from_first_pose");
  refused("/first_pose_s", -1, "first_pose_s");
  refused("/real_time_ratio", nullptr, "real_time_ratio");
  refused("/stage_times_ms/edges/p50", 1e30, "stage_times_ms.edges.p50");
  refused("/absolute_trajectory_error/live/rmse_m", nullptr, "absolute_trajectory_error.live.rmse_m");
  refused("/absolute_trajectory_error/trajectory/rotation_wxyz", json({2, 0, 0, 0}), "rotation_wxyz");
  refused("/absolute_trajectory_error/trajectory/translation_m", json({0, 0}), "translation_m");
  refused("/closed_loops", json({1}), "closed_loops[0]");
  refused("/versions/libraries", "all", "versions.libraries");
}

TEST(RunFigures, cutAtAnyByteItIsRefused) {
  const TemporaryFolder folder;
  const std::string run = writeMadeRun(folder, "run", makeRun());
  const std::string text = fileContent(run + "/summary.json");
  for (std::size_t size = 0; size + 2 < text.size(); size += 397) {
    std::ofstream(run + "/summary.json") << text.substr(0, size);
    expectInputError([&] { readRunFigures(run); }, "summary.json", "line");
  }
}

TEST(RunFigures, nonsenseIsRefused) {
  const TemporaryFolder folder;
  expectInputError([&] { readRunFigures(folder.path("nowhere")); }, "nowhere/summary.json", "no such file");
  for (const std::string text : {"NaN", "[1]", "{\"frames\": NaN}", "\xff\xfe{}", "null"}) {
    folder.write("run/summary.json", text);
    expectInputError([&] { readRunFigures(folder.path("run")); }, "summary.json", "expected");
  }
  folder.write("run/summary.json", std::string(1000000, '['));
  expectInputError([&] { readRunFigures(folder.path("run")); }, "summary.json");
  std::filesystem::create_directories(folder.path("odd/summary.json"));
  expectInputError([&] { readRunFigures(folder.path("odd")); }, "not a regular file");
  std::filesystem::resize_file(folder.path("run/summary.json"), std::uintmax_t{1} << 32U);
  expectInputError([&] { readRunFigures(folder.path("run")); }, "at most 64 MiB");
}

}  // namespace
}  // namespace edgeslam
