// What report.html draws, as JSON: positions rounded and turned so that z is up, series thinned to what a screen can
// show.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"
#include "report/run_description.h"
#include "report/run_summary.h"

namespace edgeslam {

nlohmann::ordered_json reportData(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                                  const std::optional<Trajectory>& ground_truth);

}  // namespace edgeslam
