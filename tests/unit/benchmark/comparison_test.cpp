#include "benchmark/comparison.h"

#include <gtest/gtest.h>

#include "unit/benchmark/made_run_folder.h"

namespace edgeslam {
namespace {

using nlohmann::json;

// The made run in another frame and unit, as another run over the same recording would be.
RunResult elsewhere(double scale) {
  RunResult run = makeRun();
  const Pose moved_T_world{rotationExp({0.3, -0.2, 0.9}), Eigen::Vector3d(1, 2, 3)};
  for (FrameRecord& frame : run.frames) {
    frame.final_world_T_camera = moved_T_world * frame.final_world_T_camera;
    frame.final_world_T_camera.translation *= scale;
  }
  return run;
}

json compared(const std::string& a, const std::string& b) {
  return dataIn(formatComparison(readComparedRun(a), readComparedRun(b)));
}

double largest(const json& values) {
  double most = 0;
  for (const json& value : values) most = std::max(most, value.get<double>());
  return most;
}

TEST(Comparison, bothRunsAreInTheGroundTruthsFrame) {
  const TemporaryFolder folder;
  const json data = compared(writeMadeRun(folder, "a", makeRun()), writeMadeRun(folder, "b", elsewhere(3)));
  EXPECT_EQ(data["relation"], "ground truth");
  EXPECT_EQ(data["unit"], "m");
  const Trajectory truth = madeGroundTruth();
  for (const char* run : {"first", "second"}) {
    const json& positions = data[run]["trajectory"]["positions"];
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(positions[k].get<double>(),
                  truth[made_initialising_frames].world_T_camera.translation[static_cast<int>(k)], 1e-3);
    }
  }
  EXPECT_LT(largest(data["distance"]["distances"]), 1e-4);
}

TEST(Comparison, withoutGroundTruthTheSecondIsAlignedToTheFirst) {
  const TemporaryFolder folder;
  RunResult other = elsewhere(3);
  other.frames[50].final_world_T_camera.translation.x() += 0.3;
  const json data = compared(writeMadeRun(folder, "a", makeRun(), describeMadeRun(), std::nullopt),
                             writeMadeRun(folder, "b", other, describeMadeRun(), std::nullopt));
  EXPECT_EQ(data["relation"], "first run");
  EXPECT_EQ(data["unit"], "map units");
  EXPECT_NEAR(largest(data["distance"]["distances"]), 0.1, 0.01);
  EXPECT_EQ(data["distance"]["times"].size(), data["first"]["trajectory"]["times"].size());
}

TEST(Comparison, runsOverDifferentTimesAreNotAligned) {
  const TemporaryFolder folder;
  RunResult later = makeRun();
  for (FrameRecord& frame : later.frames) frame.time_ns += 3600000000000;
  const json data = compared(writeMadeRun(folder, "a", makeRun()), writeMadeRun(folder, "b", later));
  EXPECT_EQ(data["relation"], "none");
  EXPECT_TRUE(data["distance"].is_null());
  EXPECT_EQ(data["second"]["states"][0]["from"], 0);
}

TEST(Comparison, figuresAreThoseOfTheSummaries) {
  const TemporaryFolder folder;
  RunResult other = makeRun();
  other.frames[20].final_world_T_camera.translation.x() += 0.2;
  RunDescription description = describeMadeRun();
  description.configuration = "edges:\n  sigma: 1.5\n";
  description.program_version = "1.2.4";
  const std::string a = writeMadeRun(folder, "a", makeRun()), b = writeMadeRun(folder, "b", other, description);
  const json data = compared(a, b);
  const json& error = data["figures"][0];
  EXPECT_EQ(error["name"], "Trajectory error");
  for (const auto& [key, run] : {std::pair{"first", a}, std::pair{"second", b}}) {
    EXPECT_DOUBLE_EQ(error[key].get<double>(),
                     100 * summaryIn(run)["absolute_trajectory_error"]["trajectory"]["rmse_m"].get<double>());
  }
  EXPECT_EQ(error["verdict"], "worse");
  EXPECT_EQ(data["settings"], json::parse(R"([{"name":"edges.sigma","first":"1.78","second":"1.5"}])"));
  EXPECT_EQ(data["origins"], json::parse(R"([{"name":"edgeslam","first":"1.2.3","second":"1.2.4"}])"));
  std::size_t frames = 0;
  for (const json& stretch : data["first"]["states"]) frames += stretch["frames"].get<std::size_t>();
  EXPECT_EQ(frames, summaryIn(a)["frames"]["total"].get<std::size_t>());
  EXPECT_EQ(data["stages"].back()["second"]["p99"], summaryIn(b)["stage_times_ms"]["total"]["p99"]);
}

TEST(Comparison, hostileTextStaysText) {
  const TemporaryFolder folder;
  RunDescription description = describeMadeRun();
  description.sequence = "</script><script>alert(1)</script>{{data}}<!--";
  description.configuration = "</script><img>: 1\n";
  RunResult run = makeRun();
  run.frames[0].reason = "</script><img>";
  const std::string plain = writeMadeRun(folder, "a", makeRun());
  const std::string hostile = writeMadeRun(folder, "b", run, description);
  const std::string page = formatComparison(readComparedRun(hostile), readComparedRun(hostile));
  const std::string usual = formatComparison(readComparedRun(plain), readComparedRun(plain));
  for (const char* tag : {"<script", "</script", "<!--", "<img"})
    EXPECT_EQ(countOf(page, tag), countOf(usual, tag)) << tag;
  EXPECT_EQ(dataIn(page)["first"]["sequence"], description.sequence);
  for (const char* reference :
       {"src=\"http", "href=\"http", "url(http", "@import", "<link", "fetch(", "XMLHttpRequest"}) {
    EXPECT_EQ(page.find(reference), std::string::npos) << reference;
  }
  EXPECT_EQ(usual.find("{{"), std::string::npos);
}

TEST(Comparison, aRunWithoutPosesIsShownAllTheSame) {
  const TemporaryFolder folder;
  RunResult run = makeRun();
  for (FrameRecord& frame : run.frames) frame.has_final_pose = frame.has_pose = false;
  const json data = compared(writeMadeRun(folder, "a", makeRun()), writeMadeRun(folder, "b", run));
  EXPECT_EQ(data["relation"], "none");
  EXPECT_TRUE(data["second"]["trajectory"]["times"].empty());
}

TEST(Comparison, whatIsNoRunIsTold) {
  const TemporaryFolder folder;
  expectInputError([&] { readComparedRun(folder.path("nowhere")); }, "nowhere",
                   "expected the folder of a finished run");
  const std::string run = writeMadeRun(folder, "a", makeRun());
  std::filesystem::remove(run + "/frames.csv");
  expectInputError([&] { readComparedRun(run); }, "frames.csv", "no such file");
}

}  // namespace
}  // namespace edgeslam
