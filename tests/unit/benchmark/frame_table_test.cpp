#include "benchmark/frame_table.h"

#include <gtest/gtest.h>

#include "unit/benchmark/made_run_folder.h"

namespace edgeslam {
namespace {

std::string tableOf(const RunResult& run) { return formatFrameTable(run); }

std::vector<FrameRow> read(const TemporaryFolder& folder, const std::string& table) {
  folder.write("run/frames.csv", table);
  return readFrameTable(folder.path("run"));
}

TEST(FrameTable, givesBackWhatTheRunWrote) {
  const TemporaryFolder folder;
  RunResult run = makeRun();
  run.frames[3].reason = "a \"quote\", a comma\nand a line";
  const std::vector<FrameRow> rows = read(folder, tableOf(run));
  ASSERT_EQ(rows.size(), run.frames.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FrameRecord& frame = run.frames[i];
    EXPECT_EQ(rows[i].index, frame.index);
    EXPECT_EQ(rows[i].time_ns, frame.time_ns);
    EXPECT_EQ(rows[i].state, stateName(frame.state));
    EXPECT_EQ(rows[i].reason, frame.reason);
    ASSERT_EQ(rows[i].final_pose.has_value(), frame.has_final_pose);
    if (frame.has_final_pose) {
      EXPECT_LT((rows[i].final_pose->translation - frame.final_world_T_camera.translation).norm(), 1e-7);
      EXPECT_LT(rows[i].final_pose->rotation.angularDistance(frame.final_world_T_camera.rotation), 1e-7);
    }
    EXPECT_NEAR(rows[i].time_ms, frame.times.total() - frame.times[Stage::mapping], 2e-3);
  }
  EXPECT_EQ(finalTrajectory(rows).size(), finalTrajectory(run, 0).size());
}

TEST(FrameTable, posesAreThoseOfTheMainWorld) {
  const TemporaryFolder folder;
  RunResult run = makeRun();
  for (std::size_t i = 30; i < 110; ++i) run.frames[i].final_world = run.frames[i].has_final_pose ? 2 : -1;
  const std::vector<FrameRow> rows = read(folder, tableOf(run));
  EXPECT_FALSE(rows[20].final_pose);
  EXPECT_TRUE(rows[30].final_pose);
  EXPECT_FALSE(rows[made_lost_frame].final_pose);
  EXPECT_EQ(finalTrajectory(rows).size(), 79U);
}

TEST(FrameTable, aTableWithoutWorldsHasOne) {
  const TemporaryFolder folder;
  std::string table = tableOf(makeRun());
  table.replace(table.find("final_world"), 11, "final_other");
  EXPECT_EQ(finalTrajectory(read(folder, table)).size(), finalTrajectory(makeRun(), 0).size());
}

TEST(FrameTable, whatIsCutOffIsRefused) {
  const TemporaryFolder folder;
  const std::string table = tableOf(makeRun());
  const std::size_t heading = table.find('\n');
  for (std::size_t size = 0; size < table.size(); size += 131) {
    const bool ends_a_line = size > 0 && table[size - 1] == '\n';
    if (ends_a_line) continue;
    expectInputError([&] { read(folder, table.substr(0, size)); }, "frames.csv:", size <= heading ? ":1: " : "");
  }
}

TEST(FrameTable, whatIsNotANumberIsToldWithItsLine) {
  const TemporaryFolder folder;
  const std::string table = tableOf(makeRun());
  const std::string heading = table.substr(0, table.find('\n') + 1);
  const std::size_t columns = 1 + countOf(heading, ",");
  const auto row = [&](const std::string& index, const std::string& time, const std::string& x) {
    // index,time_s,state,reason, world and seven live, world and seven final
    std::string line = index + "," + time + ",tracking,,,,,,,,,,," + x + ",0,0,0,0,0,1";
    return line + std::string(columns - 1 - countOf(line, ","), ',') + "\n";
  };
  EXPECT_EQ(read(folder, heading + row("0", "1.5", "2") + row("1", "1.6", "2")).size(), 2U);
  for (const char* x : {"nan", "inf", "1e999", "1e30", "2x", "0x10"}) {
    expectInputError([&] { read(folder, heading + row("0", "1.5", x)); }, "frames.csv:2: final pose", x);
  }
  std::string other = row("0", "1.5", "2");
  other.replace(other.find(",2,0"), 1, "-1,");
  expectInputError([&] { read(folder, heading + other); }, "frames.csv:2: final_world", "0 or more");
  for (const char* time : {"nan", "", "-", "1e99"}) {
    expectInputError([&] { read(folder, heading + row("0", time, "2")); }, "frames.csv:2: time_s");
  }
  for (const char* index : {"-1", "1.5", "", "99999999999999999999"}) {
    expectInputError([&] { read(folder, heading + row(index, "1.5", "2")); }, "frames.csv:2: index");
  }
  expectInputError([&] { read(folder, heading + row("0", "1.5", "2") + row("1", "1.5", "2")); }, ":3: ", "increase");
  expectInputError([&] { read(folder, heading + row("1", "1.5", "2") + row("1", "1.6", "2")); }, ":3: ", "increase");
  expectInputError([&] { read(folder, heading + "0,1.5,tracking\n"); }, ":2: ", "columns");
  expectInputError([&] { read(folder, heading + "0,1.5,\"tracking\n"); }, ":2: ", "does not end");
  expectInputError([&] { read(folder, "index,time_s\n"); }, ":1: ", "column state");
  expectInputError([&] { read(folder, ""); }, ":1: ", "empty");
}

}  // namespace
}  // namespace edgeslam
