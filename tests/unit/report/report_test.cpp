#include "report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/display_frame.h"
#include "report/report_assets.h"
#include "report/report_data.h"
#include "report/report_map.h"
#include "report/report_published.h"
#include "unit/report/made_run.h"

namespace edgeslam {
namespace {

std::string pageOf(const RunResult& run, const RunDescription& description, const std::optional<Trajectory>& truth) {
  return formatReport(run, summarise(run, truth), description, truth);
}

nlohmann::json dataIn(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="run">)";
  const std::size_t begin = page.find(open);
  if (begin == std::string::npos) return {};
  const std::size_t end = page.find("</script>", begin);
  return nlohmann::json::parse(page.substr(begin + open.size(), end - begin - open.size()));
}

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Report, needsNoNetwork) {
  std::string page = pageOf(makeRun(), describeMadeRun(), madeGroundTruth());
  for (const char* reference : {"src=\"http", "href=\"http", "src='http", "url(http", "@import", "<link"}) {
    EXPECT_EQ(page.find(reference), std::string::npos) << reference;
  }
  // three.js names papers and authors in comments; beyond it only namespaces look like addresses.
  for (const std::string_view library : {reportAssets().three, reportAssets().orbit_controls}) {
    page.erase(page.find(library), library.size());
  }
  for (const char* loader : {"fetch(", "XMLHttpRequest", "Loader(", "import("}) {
    EXPECT_EQ(page.find(loader), std::string::npos) << loader;
  }
  for (std::size_t at = page.find("://"); at != std::string::npos; at = page.find("://", at + 1)) {
    EXPECT_EQ(page.substr(at + 3, 11), "www.w3.org/") << page.substr(at > 40 ? at - 40 : 0, 80);
  }
}

TEST(Report, everyPartIsFilledIn) {
  const std::string page = pageOf(makeRun(), describeMadeRun(), madeGroundTruth());
  const ReportAssets assets = reportAssets();
  for (const std::string_view part : {assets.style, assets.three, assets.orbit_controls, assets.charts,
                                      assets.trajectory, assets.map, assets.script}) {
    ASSERT_GT(part.size(), 500U);
    EXPECT_NE(page.find(part), std::string::npos) << part.substr(0, 60);
  }
  EXPECT_EQ(page.find("{{"), std::string::npos);
}

TEST(Report, hostileNamesStayText) {
  RunDescription description = describeMadeRun();
  description.sequence = "</script><script>alert(1)</script>{{data}}<!--";
  description.configuration = "# </script> \xff\xfe <!-- <script";
  RunResult run = makeRun();
  run.frames[0].reason = "</script><img>";
  const std::string plain = pageOf(makeRun(), describeMadeRun(), std::nullopt);
  const std::string page = pageOf(run, description, std::nullopt);
  for (const char* tag : {"<script", "</script", "<!--", "<img"})
    EXPECT_EQ(countOf(page, tag), countOf(plain, tag)) << tag;
  const nlohmann::json data = dataIn(page);
  EXPECT_EQ(data["summary"]["sequence"], description.sequence);
  EXPECT_EQ(data["states"][0]["reason"], run.frames[0].reason);
}

TEST(Report, withGroundTruthAllIsInItsFrame) {
  const nlohmann::json data = dataIn(pageOf(makeRun(), describeMadeRun(), madeGroundTruth()));
  EXPECT_EQ(data["unit"], "m");
  EXPECT_EQ(data["axes"], nlohmann::json({"x", "y", "z"}));
  ASSERT_EQ(data["truth"]["times"].size(), static_cast<std::size_t>(made_frames));
  // The estimate is exact: its poses lie on the ground truth's, in metres.
  const std::size_t offset = data["truth"]["times"].size() - data["trajectory"]["times"].size() - 1;
  for (std::size_t i = 0; i < 3 * 40; ++i) {
    EXPECT_NEAR(data["trajectory"]["positions"][i].get<double>(),
                data["truth"]["positions"][i + 3 * offset].get<double>(), 1e-3);
  }
  const double step = data["map"]["step"];
  for (std::size_t i = 1; i < data["map"]["positions"].size(); i += 3) {
    EXPECT_NEAR(step * data["map"]["positions"][i].get<double>(), 4, 1e-3);  // the made lines stand in the plane y = 4
  }
}

TEST(Report, withoutGroundTruthUpIsMinusYOfTheFirstKeyframe) {
  const RunResult run = makeRun();
  const DisplayFrame frame = displayFrame(run, summarise(run, std::nullopt));
  EXPECT_FALSE(frame.aligned);
  EXPECT_LT((frame.display_T_world * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(1, 3, -2)).norm(), 1e-12);
}

TEST(Report, aGroundTruthWithYUpIsTurned) {
  const RunResult run = makeRun();
  Trajectory truth = madeGroundTruth();
  const Pose turn{Eigen::Quaterniond(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX())), Eigen::Vector3d::Zero()};
  for (StampedPose& pose : truth) pose.world_T_camera = turn * pose.world_T_camera;
  const DisplayFrame frame = displayFrame(run, summarise(run, truth));
  EXPECT_EQ(frame.z_name, "y");
  EXPECT_LT((frame.display_R_reference * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(frame.display_R_reference.toRotationMatrix().determinant(), 1, 1e-12);
}

TEST(Report, drawsTheMainWorldAlone) {
  RunResult run = makeRun();
  for (std::size_t i = 100; i < 120; ++i) run.frames[i].world = run.frames[i].final_world = 1;
  run.keyframes.back().world = 1;
  for (MapPointRecord& point : run.map_points) point.world = point.chain == 2 ? 1 : 0;
  for (const int world : {0, 1, 0}) {
    MapLineRecord line;
    line.to = {0, 1, 2};
    line.world = world;
    run.map_lines.push_back(line);
  }
  run.map_lines.back().to.z() = std::numeric_limits<double>::quiet_NaN();
  const nlohmann::json data = dataIn(pageOf(run, describeMadeRun(), std::nullopt));
  ASSERT_EQ(data["map"]["straight"].size(), 6U);
  EXPECT_NE(data["map"]["straight"][5].get<int>(), data["map"]["straight"][2].get<int>());
  EXPECT_EQ(data["trajectory"]["times"].size(), 89U);
  EXPECT_EQ(data["live"]["times"].size(), 89U);
  EXPECT_EQ(data["keyframes"].size(), run.keyframes.size() - 1);
  EXPECT_EQ(data["map"]["points"], run.map_points.size() - made_points_per_line);
  EXPECT_EQ(data["map"]["lines"].size(), static_cast<std::size_t>(made_lines - 1));
  EXPECT_FALSE(data["states"].back()["final_pose"].get<bool>());
  EXPECT_EQ(data["worlds_in_words"], "2 maps that were not joined: 89 frames in the main one, 20 in others");
  EXPECT_EQ(data["summary"]["worlds"].size(), 2U);
  EXPECT_EQ(dataIn(pageOf(makeRun(), describeMadeRun(), std::nullopt))["worlds_in_words"], "");
}

TEST(Report, publishedFiguresAreFoundByEveryNameOfASequence) {
  for (const char* name :
       {"fr2_desk", "rgbd_dataset_freiburg2_desk", "/data/rgbd_dataset_freiburg2_desk/", "FR2_DESK.tgz"}) {
    ASSERT_TRUE(publishedErrors(name)) << name;
    EXPECT_EQ(publishedErrors(name)->edge_slam, "1.75");
  }
  for (const char* name : {"office2", "ICL_office2", "office_traj2_frei_png", "of_kt2_frei_png", "icl-office2"}) {
    ASSERT_TRUE(publishedErrors(name)) << name;
    EXPECT_EQ(publishedErrors(name)->edge_slam, "2.97");
  }
  EXPECT_EQ(publishedErrors("rgbd_dataset_freiburg3_structure_notexture_far")->orb_slam, "X");
  for (const char* name : {"", "/", "office4", "office_lowtex", "desk", "fr2_desk_with_person", "xyz"}) {
    EXPECT_FALSE(publishedErrors(name)) << name;
  }
  EXPECT_FALSE(publishedErrors(std::string(100000, 'o')));
}

TEST(Report, longRunsAndLargeMapsStaySmall) {
  RunResult run = makeRun();
  const std::deque<FrameRecord> frames = run.frames;
  const std::vector<MapPointRecord> points = run.map_points;
  for (std::int64_t i = made_frames; i < 30000; ++i) {
    run.frames.push_back(frames[static_cast<std::size_t>(20 + i % 20)]);
    run.frames.back().index = i;
    run.frames.back().time_ns = frames[0].time_ns + i * 33333333;
    run.frames.back().reason = "number " + std::to_string(i);
  }
  for (int i = 0; i < 300000; ++i) {
    run.map_points.push_back(points[static_cast<std::size_t>(i) % points.size()]);
    run.map_points.back().chain = made_lines + i / 25;
    run.map_points.back().position *= 1 + 1e-5 * (i % 1000);
  }
  run.map_points[3].position.x() = std::numeric_limits<double>::quiet_NaN();
  run.map_points[4].position.x() = 1e30;
  const std::string page = pageOf(run, describeMadeRun(), std::nullopt);
  EXPECT_LT(page.size(), 15000000U);
  const nlohmann::json data = dataIn(page);
  EXPECT_EQ(data["map"]["points"], run.map_points.size());
  EXPECT_LT(data["map"]["shown"].get<std::size_t>(), run.map_points.size());
  EXPECT_EQ(data["map"]["positions"].size(), 3 * data["map"]["shown"].get<std::size_t>());
}

TEST(ReportMap, pointsOfAnEdgeAreJoinedInOrder) {
  RunResult run = makeRun();
  std::swap(run.map_points[3], run.map_points[40]);  // the order in which they come does not matter
  const auto lines = joinChains(run.map_points, {Eigen::Vector3d::Zero()});
  ASSERT_EQ(lines.size(), static_cast<std::size_t>(made_lines));
  for (const auto& line : lines) {
    ASSERT_EQ(line.size(), static_cast<std::size_t>(made_points_per_line));
    for (std::size_t i = 1; i < line.size(); ++i) {
      EXPECT_LT(run.map_points[static_cast<std::size_t>(line[i - 1])].order,
                run.map_points[static_cast<std::size_t>(line[i])].order);
    }
  }
}

TEST(ReportMap, aPointFarOffItsEdgeBreaksTheLine) {
  RunResult run = makeRun();
  run.map_points[12].position *= 3;
  run.map_points[made_points_per_line + 5].position.z() = std::numeric_limits<double>::infinity();
  const auto lines = joinChains(run.map_points, {Eigen::Vector3d::Zero()});
  EXPECT_EQ(lines.size(),
            static_cast<std::size_t>(made_lines + 2));  // before, itself, behind; the infinite one is only left out
  std::size_t points = 0;
  for (const auto& line : lines) points += line.size();
  EXPECT_EQ(points, run.map_points.size() - 1);
}

TEST(ReportMap, pointsWithoutAChainStayAlone) {
  std::vector<MapPointRecord> points(5);
  EXPECT_EQ(joinChains(points, {}).size(), 5U);
}

}  // namespace
}  // namespace edgeslam
