// `edgeslam benchmark` over small recordings, and `edgeslam report` of what it left. ctest makes the recording
// (CMakeLists.txt); by hand: `ctest -R system.Benchmark`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "system/program.h"

namespace edgeslam {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json dataIn(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="data">)";
  const std::size_t begin = page.find(open);
  if (begin == std::string::npos) return {};
  const std::size_t end = page.find("</script>", begin);
  return json::parse(page.substr(begin + open.size(), end - begin - open.size()));
}

json runIn(const json& data, const std::string& name) {
  for (const json& run : data["runs"]) {
    if (run["name"] == name) return run;
  }
  ADD_FAILURE() << name << " is not on the page";
  return {};
}

class Benchmark : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string small = std::string(EDGESLAM_RUN_FOLDER) + "/small";
    ASSERT_TRUE(fs::exists(small + "/rgb.txt")) << "this test needs ctest's fixtures, which make " << small;
    fs::create_directories(folder_.path("data/day1"));
    fs::copy(small, folder_.path("data/hall"), fs::copy_options::recursive);
    fs::copy(small, folder_.path("data/day1/rgbd_dataset_freiburg2_desk"), fs::copy_options::recursive);
  }
  Outcome benchmark(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"benchmark", folder_.path("data"), "--output", folder_.path("out")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }
  json page(const std::string& name = "out/index.html") const { return dataIn(fileContent(folder_.path(name))); }
  json summary(const std::string& run) const {
    return json::parse(fileContent(folder_.path("out/" + run + "/summary.json")));
  }

  TemporaryFolder folder_;
};

TEST_F(Benchmark, runsAllShowsAllAndGoesOnWhereItWas) {
  folder_.write("data/broken/rgb.txt", "nonsense\n");
  const Outcome first = benchmark({"--jobs", "2"});
  EXPECT_EQ(first.exit_code, 1) << first.messages;
  EXPECT_NE(first.messages.find("3 of 3 done (1 failed)"), std::string::npos) << first.messages;
  const json data = page();
  ASSERT_EQ(data["runs"].size(), 3U);
  const json broken = runIn(data, "broken");
  EXPECT_TRUE(broken["failed"].get<bool>());
  EXPECT_NE(broken["message"].get<std::string>().find("rgb.txt:1"), std::string::npos) << broken["message"];
  for (const std::string name : {"hall", "rgbd_dataset_freiburg2_desk"}) {
    const json run = runIn(data, name), left = summary(name);
    EXPECT_FALSE(run["failed"].get<bool>()) << name;
    EXPECT_EQ(run["figures"]["trajectory"]["rmse_m"], left["absolute_trajectory_error"]["trajectory"]["rmse_m"]);
    EXPECT_EQ(run["figures"]["coverage"], left["coverage_from_first_pose"]);
    EXPECT_EQ(run["figures"]["tracking_ms"]["p50"], left["stage_times_ms"]["tracking"]["p50"]);
    EXPECT_EQ(run["link"], name + "/report.html");
    EXPECT_TRUE(fs::exists(folder_.path("out/" + name + "/report.html")));
  }
  EXPECT_EQ(runIn(data, "rgbd_dataset_freiburg2_desk")["published"]["errors_cm"]["ORB-SLAM"], "0.88");

  // A second time only what failed is run; the rest is there as it was.
  const auto written = fs::last_write_time(folder_.path("out/hall/summary.json"));
  const Outcome second = benchmark({"--jobs", "2"});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.messages.find("2 finished before"), std::string::npos) << second.messages;
  EXPECT_EQ(fs::last_write_time(folder_.path("out/hall/summary.json")), written);
  EXPECT_EQ(page(), data);

  // Other settings are another run.
  const std::string settings = folder_.write("robot.yaml", "lcm:\n  ttl: 1\n");
  const Outcome third = benchmark({"--only", "hall", "--config", settings});
  EXPECT_EQ(third.exit_code, 0) << third.messages;
  EXPECT_EQ(third.messages.find("finished before"), std::string::npos) << third.messages;
  EXPECT_NE(fs::last_write_time(folder_.path("out/hall/summary.json")), written);
  EXPECT_EQ(page()["runs"].size(), 3U) << "what was not chosen is still shown";

  // The folder's page once more, and two of its runs side by side.
  EXPECT_EQ(runProgram({"report", folder_.path("out"), "--output", folder_.path("set.html")}).exit_code, 0);
  EXPECT_EQ(runIn(page("set.html"), "hall")["link"], "out/hall/report.html");
  EXPECT_EQ(runProgram({"report", folder_.path("out/hall"), folder_.path("out/rgbd_dataset_freiburg2_desk"), "--output",
                        folder_.path("two.html")})
                .exit_code,
            0);
  const json two = page("two.html");
  EXPECT_EQ(two["relation"], "ground truth");
  EXPECT_EQ(two["distance"]["max"], 0);  // the same frames give the same trajectory to the last bit
  EXPECT_EQ(two["settings"], json::parse(R"([{"name":"lcm.ttl","first":"1","second":"-"}])"));
}

TEST_F(Benchmark, aSequenceWithoutACalibrationGetsThePublishedOne) {
  const std::string desk = folder_.path("data/fr1_desk");
  ASSERT_EQ(runProgram({"simulate", "panels_textured", "--frames", "4", "--output", desk}).exit_code, 0);
  fs::remove(desk + "/camera.yaml");
  EXPECT_EQ(benchmark({"--only", "fr1_desk"}).exit_code, 1);  // four frames start no map
  const json left = summary("fr1_desk");
  EXPECT_NE(left["configuration"].get<std::string>().find("517.3"), std::string::npos);
  EXPECT_NE(runIn(page(), "fr1_desk")["message"].get<std::string>().find("no pose"), std::string::npos);
  const Outcome again = benchmark({"--only", "fr1_desk"});
  EXPECT_NE(again.messages.find("1 finished before"), std::string::npos) << again.messages;
  EXPECT_EQ(again.exit_code, 1);
}

TEST_F(Benchmark, wrongUseIsTold) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--only", "no_such"}, {"--jobs", "0"}}) {
    const Outcome outcome = benchmark(more);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.messages;
    EXPECT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  }
  EXPECT_EQ(runProgram({"benchmark", folder_.path("nowhere"), "--output", folder_.path("out")}).exit_code, 2);
  EXPECT_EQ(runProgram({"report", folder_.path("data"), "--output", folder_.path("x.html")}).exit_code, 2);
  EXPECT_EQ(runProgram({"report", folder_.path("data"), folder_.path("data")}).exit_code, 2);
}

}  // namespace
}  // namespace edgeslam
