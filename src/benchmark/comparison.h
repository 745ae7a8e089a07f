// Two finished runs side by side, in one page that needs no network.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/frame_table.h"
#include "benchmark/run_figures.h"

namespace edgeslam {

struct ComparedRun {
  std::string folder;  // as given
  RunFigures figures;
  std::vector<FrameRow> frames;
};

// Throws InputError as readRunFigures and readFrameTable do.
ComparedRun readComparedRun(const std::string& folder);

// What the page shows, as JSON. Both trajectories are in the ground truth's frame [m] where both runs are aligned to
// one; otherwise the second is aligned to the first (similarity, poses at the same times); where they share fewer than
// three times each stays in a frame of its own, and nothing is said of the distance between them.
nlohmann::ordered_json comparisonData(const ComparedRun& first, const ComparedRun& second);

std::string formatComparison(const ComparedRun& first, const ComparedRun& second);

}  // namespace edgeslam
