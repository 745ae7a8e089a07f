#include "benchmark/figure_changes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgeslam {
namespace {

RunFigures figures(double error_m, double coverage, double tracking_ms) {
  RunFigures run;
  run.trajectory = ErrorFigures{100, error_m, error_m, error_m, error_m, std::nullopt};
  run.coverage = coverage;
  run.first_pose_s = 1;
  run.stages.push_back({"tracking", 100, tracking_ms, tracking_ms, tracking_ms, tracking_ms});
  run.real_time_ratio = 10 / tracking_ms;
  return run;
}

FigureChange changeOf(const std::string& name, const RunFigures& a, const RunFigures& b) {
  for (const FigureChange& change : figureChanges(a, b)) {
    if (change.name == name) return change;
  }
  ADD_FAILURE() << "no figure is called " << name;
  return {};
}

TEST(FigureChanges, lessErrorAndMoreCoverageAreBetter) {
  const RunFigures a = figures(0.02, 0.9, 5), b = figures(0.01, 0.95, 5);
  EXPECT_EQ(changeOf("Trajectory error", a, b).verdict, Verdict::better);
  EXPECT_DOUBLE_EQ(*changeOf("Trajectory error", a, b).first, 2);  // [cm]
  EXPECT_EQ(changeOf("Frames with a pose, from the first on", a, b).verdict, Verdict::better);
  EXPECT_EQ(changeOf("Trajectory error", b, a).verdict, Verdict::worse);
  EXPECT_EQ(changeOf("Frames with a pose, from the first on", b, a).verdict, Verdict::worse);
}

TEST(FigureChanges, aRunIsTheSameAsItself) {
  const RunFigures a = figures(0.02, 0.9, 5);
  for (const FigureChange& change : figureChanges(a, a)) {
    EXPECT_TRUE(change.verdict == Verdict::same || change.verdict == Verdict::unknown) << change.name;
  }
}

TEST(FigureChanges, timesScatterAndMissingFiguresAreNoVerdict) {
  const RunFigures a = figures(0.02, 0.9, 5), b = figures(0.02, 0.9, 5.4);
  EXPECT_EQ(changeOf("Tracking a frame, median", a, b).verdict, Verdict::same);
  EXPECT_EQ(changeOf("Tracking a frame, median", a, figures(0.02, 0.9, 6)).verdict, Verdict::worse);
  RunFigures without = b;
  without.trajectory.reset();
  EXPECT_EQ(changeOf("Trajectory error", a, without).verdict, Verdict::unknown);
  RunFigures more = a;
  more.keyframes = 4;
  EXPECT_EQ(changeOf("Keyframes", a, more).verdict, Verdict::different);
}

TEST(SettingChanges, areThoseLinesThatDiffer) {
  const std::string a = "camera:\n  width: 640\nedges:\n  sigma: 1.78\n  only_here: 1\nflow:\n  sigma: 2\n";
  const std::string b = "camera:\n  width: 640\nedges:\n  sigma: 1.5\nflow:\n  sigma: 2\n  new: {a: 1}\n";
  const std::vector<SettingChange> changes = settingChanges(a, b);
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[0].key, "edges.sigma");
  EXPECT_EQ(changes[0].first, "1.78");
  EXPECT_EQ(changes[0].second, "1.5");
  EXPECT_EQ(changes[1].key, "edges.only_here");
  EXPECT_EQ(changes[1].second, "-");
  EXPECT_EQ(changes[2].key, "flow.new");
  EXPECT_EQ(changes[2].first, "-");
  EXPECT_TRUE(settingChanges(a, a).empty());
}

TEST(SettingChanges, anyTextIsTaken) {
  for (const std::string text : {"", "\n\n", ":", "a", " x", "\t:\n:::", "# comment\n"}) {
    EXPECT_TRUE(settingChanges(text, text).empty());
    settingChanges(text, "edges:\n  sigma: 1\n");
  }
}

}  // namespace
}  // namespace edgeslam
