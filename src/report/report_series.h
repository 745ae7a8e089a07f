// What the report shows over time: states, numbers of points, time of the stages, errors.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "pipeline/run_result.h"
#include "report/report_scale.h"
#include "report/run_summary.h"

namespace edgeslam {

// Stretches of frames in one state.
nlohmann::ordered_json stateRunsJson(const RunResult& result, const Clock& clock);

// Points tracked and mapped.
nlohmann::ordered_json framesJson(const RunResult& result, const Clock& clock);

// Times of each stage that ran [ms].
nlohmann::ordered_json stageSeriesJson(const RunResult& result, const RunSummary& summary, const Clock& clock);

// [cm]; null without an error.
nlohmann::ordered_json errorSeriesJson(const std::optional<AbsoluteError>& error, const Clock& clock);

}  // namespace edgeslam
