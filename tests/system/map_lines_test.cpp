// What a run took for straight edges of the scene, against the truth: the views of a line are views of one edge, and an
// edge is one line. The sequences are made by ctest (see CMakeLists.txt).
#include <gtest/gtest.h>

#include "system/run_result.h"
#include "system/true_lines.h"

namespace edgeslam {
namespace {

struct Expected {
  std::string sequence;
  int fewest_lines;
  double purity;        // share of the views that are of the edge that most views of their line are of
  double completeness;  // share of the lines that are the only ones of their edge
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.sequence; }

class MapLines : public ::testing::TestWithParam<Expected> {};

TEST_P(MapLines, AreStraightEdgesOfTheScene) {
  constexpr double largest_misfit_px = 2;
  const std::string sequence = std::string(EDGESLAM_RUN_FOLDER) + "/" + GetParam().sequence;
  const TemporaryFolder folder;
  const std::string file = folder.path("place.map");
  const ReplayedRun run = replayed(sequence, folder.path("result"), {"--map-out", file});
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.messages;
  const SavedMap saved = decodeMap(fileContent(file), file);
  const SeenLines lines = seenLines(saved, readTrajectory(sequence + "/groundtruth.txt"),
                                    largest_misfit_px / meanFocalLength(saved.camera));
  EXPECT_GE(lines.lines, GetParam().fewest_lines);
  EXPECT_GE(lines.purity(), GetParam().purity);
  EXPECT_GE(lines.completeness(), GetParam().completeness);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MapLines,
                         ::testing::Values(Expected{"bare", 7, 0.98, 0.9}, Expected{"parlour", 6, 0.98, 0.9},
                                           Expected{"dim_corridor", 20, 0.98, 0.9}),
                         [](const auto& scene) { return scene.param.sequence; });

}  // namespace
}  // namespace edgeslam
