// report.html: a run to look at, in one file that needs no network.
#pragma once

#include <optional>
#include <string>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"
#include "report/run_description.h"
#include "report/run_summary.h"

namespace edgeslam {

// False where reports were left out of the build (EDGESLAM_REPORTS=OFF): there is no page then.
bool reportsAreBuiltIn();

// The whole page. With a ground truth that the trajectory could be aligned to, all is shown in its frame, in its unit;
// otherwise in the world frame (the first keyframe's camera), in map units. Long runs and large maps are thinned, and
// the page says so.
std::string formatReport(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                         const std::optional<Trajectory>& ground_truth);

}  // namespace edgeslam
