#include "benchmark/benchmark_run.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>

#include "benchmark/child_processes.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

// Takes the place of `edgeslam`: `replay INPUT --output FOLDER`, where the input's name says what becomes of it.
class BenchmarkRun : public ::testing::Test {
 protected:
  BenchmarkRun() {
    plan_.program = folder_.write("program", R"(#!/bin/sh
case $2 in
  *good*) echo "$5 $6" > "$4/summary.json" ;;
  *bad*) echo "edgeslam: frame 3 skipped: torn"; echo "edgeslam: bad/rgb.txt:1: nonsense" >&2; exit 2 ;;
  *none*) echo "no pose: too dark"; exit 1 ;;
  *killed*) kill -9 $$ ;;
  *endless*) touch "$4/started"; exec sleep 600 ;;
  *silent*) exit 3 ;;
esac
)");
    std::filesystem::permissions(plan_.program, std::filesystem::perms::owner_all);
    plan_.output = folder_.path("out");
    std::filesystem::create_directory(plan_.output);
    listener_.stop = [] { return false; };
    listener_.going = [this](const BenchmarkProgress& progress) {
      most_at_once_ = std::max(most_at_once_, progress.running.size());
    };
    listener_.ended = [this](const PlannedRun& run, const BenchmarkEntry&) { ended_.push_back(run.sequence.name); };
  }

  void add(const std::string& name, bool is_finished = false, const std::string& configuration = "") {
    PlannedRun run;
    run.sequence.name = name;
    run.sequence.folder = "/data/" + name;
    run.sequence.frames = 100;
    run.is_finished = is_finished;
    run.configuration_path = configuration;
    plan_.runs.push_back(run);
  }
  BenchmarkEntry entry(const std::string& name) const {
    for (const BenchmarkEntry& known : record_.entries) {
      if (known.name == name) return known;
    }
    ADD_FAILURE() << name;
    return {};
  }

  TemporaryFolder folder_;
  BenchmarkPlan plan_;
  BenchmarkRecord record_;
  BenchmarkListener listener_;
  std::vector<std::string> ended_;
  std::size_t most_at_once_ = 0;
};

TEST_F(BenchmarkRun, notesWhatBecameOfEach) {
  for (const char* name : {"good1", "bad", "none", "killed", "silent"}) add(name);
  add("good2", false, "/some/configuration.yaml");
  plan_.jobs = 3;
  EXPECT_TRUE(runBenchmark(plan_, record_, listener_));
  EXPECT_EQ(ended_.size(), 6U);
  EXPECT_LE(most_at_once_, 3U);
  EXPECT_EQ(entry("good1").exit_code, 0);
  EXPECT_EQ(entry("good1").message, "");
  EXPECT_EQ(entry("bad").exit_code, 2);
  EXPECT_EQ(entry("bad").message, "bad/rgb.txt:1: nonsense");
  EXPECT_EQ(entry("none").exit_code, 1);
  EXPECT_EQ(entry("none").message, "no pose: too dark");
  EXPECT_NE(entry("killed").exit_code, 0);
  EXPECT_NE(entry("killed").message.find("signal 9"), std::string::npos) << entry("killed").message;
  EXPECT_NE(entry("silent").message.find("exit code 3; see silent/run.log"), std::string::npos);
  EXPECT_EQ(fileContent(plan_.output + "/good2/summary.json"), "--config /some/configuration.yaml\n");
  EXPECT_EQ(readBenchmarkRecord(plan_.output).entries.size(), 6U);
}

TEST_F(BenchmarkRun, whatIsFinishedIsNotRunAgain) {
  add("good1", true);
  add("good2");
  record_.entries.resize(1);
  record_.entries[0].name = "good1";
  record_.entries[0].exit_code = 0;
  EXPECT_TRUE(runBenchmark(plan_, record_, listener_));
  EXPECT_EQ(ended_, std::vector<std::string>{"good2"});
  EXPECT_FALSE(std::filesystem::exists(plan_.output + "/good1"));
  EXPECT_EQ(entry("good1").exit_code, 0);
}

TEST_F(BenchmarkRun, whatAnEarlierRunLeftIsNotTakenForThisOnes) {
  folder_.write("out/bad/summary.json", "old");
  folder_.write("out/bad/report.html", "old");
  folder_.write("out/bad/configuration.yaml", "kept");
  add("bad");
  EXPECT_TRUE(runBenchmark(plan_, record_, listener_));
  EXPECT_FALSE(std::filesystem::exists(plan_.output + "/bad/summary.json"));
  EXPECT_FALSE(std::filesystem::exists(plan_.output + "/bad/report.html"));
  EXPECT_TRUE(std::filesystem::exists(plan_.output + "/bad/configuration.yaml"));
}

TEST_F(BenchmarkRun, stoppedItEndsTheChildrenAndKeepsWhatIsFinished) {
  add("good");
  add("endless");
  add("never");
  listener_.stop = [this] { return std::filesystem::exists(plan_.output + "/endless/started"); };
  EXPECT_FALSE(runBenchmark(plan_, record_, listener_));
  const BenchmarkRecord left = readBenchmarkRecord(plan_.output);
  ASSERT_EQ(left.entries.size(), 3U);
  EXPECT_EQ(left.entries[0].exit_code, 0);
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_EQ(left.entries[i].exit_code, -1);
    EXPECT_EQ(left.entries[i].message, "was not run to its end");
  }
}

TEST(ChildProcesses, childrenDieWithTheirOwner) {
  const TemporaryFolder folder;
  {
    ChildProcesses children;
    children.start(0, {"/bin/sh", "-c", "echo $$; exec sleep 600"}, folder.path("log"));
    while (fileContent(folder.path("log")).empty()) children.waitForOne(0.01);
    EXPECT_EQ(children.running(), 1U);
  }
  const pid_t child = std::stoi(fileContent(folder.path("log")));
  EXPECT_NE(kill(child, 0), 0) << "it is still there";
}

TEST(ChildProcesses, aProgramThatIsNotThereIsAFailure) {
  const TemporaryFolder folder;
  ChildProcesses children;
  children.start(7, {"/no/such/program"}, folder.path("log"));
  const auto end = children.waitForOne(60);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->number, 7U);
  EXPECT_NE(end->exit_code, 0);
  expectInputError([&] { children.start(0, {"/bin/true"}, folder.path("no/folder/log")); }, "no/folder/log");
}

TEST(BenchmarkProgress, saysHowMuchIsLeft) {
  BenchmarkProgress progress;
  progress.total = 8, progress.done = 3, progress.failed = 1;
  progress.running = {"desk", "xyz"};
  EXPECT_EQ(formatProgress(progress), "3 of 8 done (1 failed), running desk, xyz");
  progress.left_s = 100;
  EXPECT_EQ(formatProgress(progress), "3 of 8 done (1 failed), running desk, xyz; about 2 min left");
  progress.left_s = 12.2, progress.failed = 0, progress.running.clear();
  EXPECT_EQ(formatProgress(progress), "3 of 8 done; about 13 s left");
}

}  // namespace
}  // namespace edgeslam
