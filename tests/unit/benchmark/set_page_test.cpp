#include "benchmark/set_page.h"

#include <gtest/gtest.h>

#include "benchmark/benchmark_record.h"
#include "unit/benchmark/made_run_folder.h"

namespace edgeslam {
namespace {

using nlohmann::json;

BenchmarkEntry entry(const std::string& name, const std::string& input, int exit_code,
                     const std::string& message = "") {
  BenchmarkEntry made;
  made.name = name, made.input = input, made.exit_code = exit_code, made.message = message;
  made.fingerprint = "0123456789abcdef";
  return made;
}

// Two runs, one of them of the paper's, one that failed and one whose summary was damaged.
BenchmarkRecord makeBenchmark(const TemporaryFolder& folder) {
  const std::string desk = "/data/rgbd_dataset_freiburg2_desk";
  writeMadeRun(folder, "out/helix", makeRun());
  writeMadeRun(folder, "out/rgbd_dataset_freiburg2_desk", makeRun(), describeRunOver(desk));
  folder.write("out/damaged/summary.json", "{\"frames\": ");
  BenchmarkRecord record;
  record.source = "/data";
  record.entries = {entry("damaged", "/data/damaged", 0), entry("helix", "/recordings/helix", 0),
                    entry("broken <b>", "/data/broken", 2, "rgb.txt:1: <script>nonsense</script>"),
                    entry("rgbd_dataset_freiburg2_desk", desk, 0)};
  writeBenchmarkRecord(folder.path("out"), record);
  return record;
}

json runIn(const json& data, const std::string& name) {
  for (const json& run : data["runs"]) {
    if (run["name"] == name) return run;
  }
  ADD_FAILURE() << name << " was dropped";
  return {};
}

TEST(SetPage, hasTheFiguresOfEachRunsSummary) {
  const TemporaryFolder folder;
  const BenchmarkRecord record = makeBenchmark(folder);
  const json data = dataIn(formatSetPage(setOfBenchmark(folder.path("out"), record, folder.path("out"))));
  const json figures = runIn(data, "helix")["figures"];
  const json summary = summaryIn(folder.path("out/helix"));
  EXPECT_EQ(figures["trajectory"]["rmse_m"], summary["absolute_trajectory_error"]["trajectory"]["rmse_m"]);
  EXPECT_EQ(figures["live"]["rmse_m"], summary["absolute_trajectory_error"]["live"]["rmse_m"]);
  EXPECT_EQ(figures["keyframe_error"]["rmse_m"], summary["absolute_trajectory_error"]["keyframes"]["rmse_m"]);
  EXPECT_EQ(figures["coverage"], summary["coverage_from_first_pose"]);
  EXPECT_EQ(figures["worlds"], 1);
  EXPECT_EQ(figures["posed"], summary["frames"]["with_pose"].get<double>() / made_frames);
  EXPECT_EQ(figures["posed_in_any_world"], figures["posed"]);
  EXPECT_EQ(figures["tracking_ms"]["p99"], summary["stage_times_ms"]["tracking"]["p99"]);
  EXPECT_EQ(figures["states"], summary["states"]);
  EXPECT_EQ(figures["real_time_ratio"], summary["real_time_ratio"]);
}

TEST(SetPage, thePapersFiguresStandBesideItsSequences) {
  const TemporaryFolder folder;
  const BenchmarkRecord record = makeBenchmark(folder);
  const json data = dataIn(formatSetPage(setOfBenchmark(folder.path("out"), record, folder.path("out"))));
  const json published = runIn(data, "rgbd_dataset_freiburg2_desk")["published"];
  EXPECT_EQ(published["sequence"], "fr2_desk");
  EXPECT_EQ(published["errors_cm"]["Edge SLAM (paper)"], "1.75");
  EXPECT_EQ(published["errors_cm"].size(), 5U);
  EXPECT_TRUE(runIn(data, "helix")["published"].is_null());
}

TEST(SetPage, linksLeadToTheReportsFromWhereverThePageLies) {
  const TemporaryFolder folder;
  const BenchmarkRecord record = makeBenchmark(folder);
  const std::string out = folder.path("out");
  EXPECT_EQ(runIn(setData(setOfBenchmark(out, record, out)), "helix")["link"], "helix/report.html");
  EXPECT_EQ(runIn(setData(setOfBenchmark(out, record, folder.path())), "helix")["link"], "out/helix/report.html");
  EXPECT_EQ(runIn(setData(setOfBenchmark(out, record, folder.path("pages"))), "helix")["link"],
            "../out/helix/report.html");
  EXPECT_EQ(relativeLink("/a", "/a/javascript:x \"<b>%\n/report.html"),
            "javascript%3Ax%20%22%3Cb%3E%25%0A/report.html");
}

TEST(SetPage, failedRunsAreShownWithTheirMessage) {
  const TemporaryFolder folder;
  const BenchmarkRecord record = makeBenchmark(folder);
  const RunSet set = setOfBenchmark(folder.path("out"), record, folder.path("out"));
  const std::string page = formatSetPage(set);
  const json data = dataIn(page);
  EXPECT_EQ(data["runs"].size(), 4U);
  EXPECT_TRUE(runIn(data, "broken <b>")["failed"].get<bool>());
  EXPECT_EQ(runIn(data, "broken <b>")["message"], "rgb.txt:1: <script>nonsense</script>");
  EXPECT_TRUE(runIn(data, "damaged")["failed"].get<bool>());
  EXPECT_NE(runIn(data, "damaged")["message"].get<std::string>().find("summary.json"), std::string::npos);
  EXPECT_EQ(page.find("<script>nonsense"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  const std::string table = formatSetTable(set);
  EXPECT_EQ(countOf(table, "\n"), 5U);
  EXPECT_NE(table.find("broken <b>"), std::string::npos);
  EXPECT_NE(table.find("1.75"), std::string::npos);
}

TEST(SetPage, namesCannotSteerTheTerminal) {
  RunSet set;
  SetRun run;
  run.name = "a\x1b[2Jb\n", run.failed = true, run.message = "x\ry";
  set.runs.push_back(run);
  const std::string table = formatSetTable(set);
  EXPECT_EQ(table.find('\x1b'), std::string::npos);
  EXPECT_EQ(table.find('\r'), std::string::npos);
  EXPECT_EQ(countOf(table, "\n"), 2U);
}

TEST(SetPage, ofSingleRunsNeedsThemAll) {
  const TemporaryFolder folder;
  const std::string a = writeMadeRun(folder, "a", makeRun());
  const RunSet set = setOfRuns({a, a + "/", a}, folder.path());
  ASSERT_EQ(set.runs.size(), 3U);
  EXPECT_EQ(set.runs[1].name, "a (helix)");
  EXPECT_EQ(set.runs[1].link, "a/report.html");
  expectInputError([&] { setOfRuns({a, folder.path("none"), a}, folder.path()); }, "none/summary.json");
}

TEST(BenchmarkRecord, givesBackWhatWasWritten) {
  const TemporaryFolder folder;
  const BenchmarkRecord written = makeBenchmark(folder);
  const BenchmarkRecord read = readBenchmarkRecord(folder.path("out"));
  EXPECT_EQ(read.source, written.source);
  ASSERT_EQ(read.entries.size(), written.entries.size());
  for (std::size_t i = 0; i < read.entries.size(); ++i) {
    EXPECT_EQ(read.entries[i].name, written.entries[i].name);
    EXPECT_EQ(read.entries[i].exit_code, written.entries[i].exit_code);
    EXPECT_EQ(read.entries[i].message, written.entries[i].message);
    EXPECT_EQ(read.entries[i].fingerprint, written.entries[i].fingerprint);
  }
}

TEST(BenchmarkRecord, namesThatLeadElsewhereAreRefused) {
  const TemporaryFolder folder;
  BenchmarkRecord record = makeBenchmark(folder);
  for (const char* name : {"..", ".", "", "../other", "/etc", "a/b"}) {
    record.entries[0].name = name;
    writeBenchmarkRecord(folder.path("out"), record);
    expectInputError([&] { readBenchmarkRecord(folder.path("out")); }, "benchmark.json", "runs[0].name");
  }
  record.entries[0].name = "helix";  // twice
  writeBenchmarkRecord(folder.path("out"), record);
  expectInputError([&] { readBenchmarkRecord(folder.path("out")); }, "runs[1].name", "no other run");
  for (const char* text : {"", "{}", "{\"version\": 2}", "[]", "{\"version\": 1, \"source\": 3}"}) {
    folder.write("out/benchmark.json", text);
    expectInputError([&] { readBenchmarkRecord(folder.path("out")); }, "benchmark.json", "expected");
  }
}

TEST(BenchmarkRecord, aRunIsFinishedOnlyForTheSameProgramConfigurationAndInput) {
  const TemporaryFolder folder;
  const BenchmarkRecord record = makeBenchmark(folder);
  const std::string out = folder.path("out");
  BenchmarkEntry helix = record.entries[1];
  const std::string fingerprint = helix.fingerprint, version = "1.2.3", configuration = describeMadeRun().configuration;
  EXPECT_TRUE(isFinished(out, helix, fingerprint, version, configuration));
  EXPECT_FALSE(isFinished(out, helix, "fedcba", version, configuration));
  EXPECT_FALSE(isFinished(out, helix, fingerprint, "1.2.4", configuration));
  EXPECT_FALSE(isFinished(out, helix, fingerprint, version, configuration + "flow:\n"));
  EXPECT_FALSE(isFinished(out, record.entries[0], fingerprint, version, configuration));  // damaged
  for (const int exit_code : {-1, 2, 255}) {
    helix.exit_code = exit_code;
    EXPECT_FALSE(isFinished(out, helix, fingerprint, version, configuration)) << exit_code;
  }
}

}  // namespace
}  // namespace edgeslam
