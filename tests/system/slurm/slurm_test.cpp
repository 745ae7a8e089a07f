// `edgeslam benchmark --slurm` on a real Slurm. ctest makes the recording; by hand: `ctest -R system.Slurm`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "system/slurm/cluster.h"

namespace edgeslam {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Slurm : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { problem_ = slurmCannotRun(); }
  void SetUp() override {
    if (!problem_.empty()) GTEST_SKIP() << problem_;
    const std::string small = std::string(EDGESLAM_RUN_FOLDER) + "/small";
    ASSERT_TRUE(fs::exists(small + "/rgb.txt")) << "this test needs ctest's fixtures, which make " << small;
    fs::create_directories(folder_.path("data"));
    fs::create_directories(folder_.path("hidden"));
    for (const std::string name : {"hall", "it's a hall"}) {
      fs::copy(small, folder_.path("data/" + name), fs::copy_options::recursive);
    }
    folder_.write("data/broken/rgb.txt", "nonsense\n");
    cluster_ = std::make_unique<SlurmCluster>(folder_.path("hidden"));
    ASSERT_TRUE(cluster_->isReady()) << cluster_->said();
  }

  std::vector<std::string> words(const std::string& output, const std::vector<std::string>& more) const {
    std::vector<std::string> all{"benchmark", folder_.path("data"), "--output", folder_.path(output)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Outcome benchmark(const std::string& output, const std::vector<std::string>& more) const {
    return runProgram(words(output, more));
  }
  std::set<std::string> files(const std::string& output) const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path(output)))
      found.insert(fs::relative(entry.path(), folder_.path(output)).string());
    return found;
  }
  json record(const std::string& output) const {
    return json::parse(fileContent(folder_.path(output + "/benchmark.json")));
  }
  static std::string queue(const std::string& format) {
    return runCommand({"squeue", "--noheader", "--array", "--states=all", "--format=" + format}).output;
  }

  TemporaryFolder folder_;
  std::unique_ptr<SlurmCluster> cluster_;
  inline static std::string problem_;
};

TEST_F(Slurm, leavesWhatOneMachineLeaves) {
  const Outcome here = benchmark("here", {"--jobs", "2"});
  const Outcome there = benchmark("there", {"--jobs", "2", "--slurm", "--partition=all --time=1:00:00"});
  EXPECT_EQ(here.exit_code, 1) << here.messages;
  EXPECT_EQ(there.exit_code, 1) << there.messages << cluster_->said();
  EXPECT_EQ(there.failures(), here.failures());
  EXPECT_NE(there.messages.find("3 of 3 done (1 failed)"), std::string::npos) << there.messages;
  EXPECT_EQ(files("there"), files("here"));
  for (const std::string name : {"hall", "it's a hall"}) {
    for (const std::string file : {"trajectory.txt", "keyframes.txt", "map.ply"}) {
      const std::string path = name + ("/" + file);
      EXPECT_EQ(fileContent(folder_.path("there/" + path)), fileContent(folder_.path("here/" + path))) << path;
    }
  }
  json first = record("here"), second = record("there");
  ASSERT_EQ(first["runs"].size(), 3U);
  for (json* const each : {&first, &second}) {
    for (json& run : (*each)["runs"]) {
      EXPECT_GT(run["cpu_s"], 0) << run;
      run.erase("cpu_s"), run.erase("peak_mib");
    }
  }
  EXPECT_EQ(second, first);
  EXPECT_EQ(queue("%l").find("UNLIMITED"), std::string::npos) << "the options reach sbatch";
  for (const std::string node : {"node1", "node2"}) EXPECT_NE(queue("%N").find(node), std::string::npos) << queue("%N");

  // What is finished is not run again.
  const auto written = fs::last_write_time(folder_.path("there/hall/summary.json"));
  const Outcome again = benchmark("there", {"--slurm"});
  EXPECT_EQ(again.exit_code, 1) << again.messages;
  EXPECT_NE(again.messages.find("2 finished before"), std::string::npos) << again.messages;
  EXPECT_EQ(fs::last_write_time(folder_.path("there/hall/summary.json")), written);
  EXPECT_EQ(benchmark("there", {"--slurm", "--only", "hall"}).exit_code, 0);
}

TEST_F(Slurm, wrongUseIsTold) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--slurm", "--partition=no_such"}, "sbatch refuses: "},
      {{"--slurm=--no-such-option"}, "sbatch refuses: "},
      {{"--slurm", "--array=0-3"}, "--array=0-3 cannot be given"},
      {{"--slurm", "--comment='open"}, "a quote is not closed"},
      {{"--partition=all"}, "--partition=all"}};
  for (const auto& [more, message] : cases) {
    const Outcome outcome = benchmark("out", more);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.messages;
    ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
    EXPECT_NE(outcome.failures()[0].find(message), std::string::npos) << outcome.messages;
  }
  const Outcome nowhere = runProgramAfter("PATH=/nowhere", words("out", {"--slurm"}));
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_NE(nowhere.messages.find("sbatch is not in the PATH"), std::string::npos) << nowhere.messages;
  EXPECT_EQ(queue("%i"), "");
}

TEST_F(Slurm, aFolderThatNodesDoNotSeeIsTold) {
  const Outcome outcome = benchmark("hidden/out", {"--slurm"});
  EXPECT_EQ(outcome.exit_code, 2) << outcome.messages;
  ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  EXPECT_NE(outcome.messages.find("expected a folder that all nodes share"), std::string::npos) << outcome.messages;
}

TEST_F(Slurm, interruptedItCancelsTheJobAndGoesOnLater) {
  std::vector<std::string> command = words("out", {"--slurm", "--hold"});
  command.insert(command.begin(), EDGESLAM_PROGRAM);
  BackgroundProcess waiting(command);
  ASSERT_TRUE(comesTrue([] { return queue("%T").find("PENDING") != std::string::npos; }, slurm_patience_s))
      << waiting.said();
  waiting.send(SIGINT);
  EXPECT_EQ(waiting.exitCode(), 1);
  EXPECT_TRUE(waiting.says(" is cancelled")) << waiting.said();
  EXPECT_TRUE(waiting.says("the same command goes on from here"));
  EXPECT_EQ(queue("%T").find("PENDING"), std::string::npos) << queue("%T");
  const Outcome later = benchmark("out", {"--slurm", "--only", "hall"});
  EXPECT_EQ(later.exit_code, 0) << later.messages;
  for (const std::string& file : files("out")) EXPECT_EQ(file.find("slurm-"), std::string::npos) << file;
}

TEST_F(Slurm, aTaskThatSlurmEndsIsTold) {
  std::vector<std::string> command = words("out", {"--slurm", "--hold"});
  command.insert(command.begin(), EDGESLAM_PROGRAM);
  BackgroundProcess waiting(command);
  ASSERT_TRUE(comesTrue([] { return queue("%T").find("PENDING") != std::string::npos; }, slurm_patience_s))
      << waiting.said();
  const std::string job = queue("%F").substr(0, queue("%F").find_first_of(" \n"));
  ASSERT_EQ(runCommand({"scancel", job + "_1"}).exit_code, 0);
  ASSERT_EQ(runCommand({"scontrol", "release", job}).exit_code, 0);
  ASSERT_TRUE(comesTrue([&] { return waiting.says("index.html shows it all"); }, slurm_patience_s)) << waiting.said();
  EXPECT_EQ(waiting.exitCode(), 1);
  EXPECT_TRUE(waiting.says("hall failed: Slurm ended job " + job + "_1 (gone from the queue)")) << waiting.said();
  EXPECT_EQ(record("out")["runs"][2]["exit_code"], 0) << waiting.said();
}

}  // namespace
}  // namespace edgeslam
