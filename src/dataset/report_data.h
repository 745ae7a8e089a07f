// What report.html draws, as JSON: positions rounded and turned so that z is up, series thinned to what a screen can
// show.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "dataset/run_description.h"
#include "dataset/run_summary.h"
#include "dataset/trajectory.h"
#include "pipeline/run_result.h"

namespace edgeslam {

nlohmann::ordered_json reportData(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                                  const std::optional<Trajectory>& ground_truth);

}  // namespace edgeslam
