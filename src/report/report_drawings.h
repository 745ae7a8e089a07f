// The drawings of a run's frames for the report.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pipeline/run_result.h"
#include "report/report_scale.h"

namespace edgeslam {

// As JPEG in data URLs, each with its frame's state; at most 24, at most 800 px wide.
nlohmann::ordered_json drawingsJson(const RunResult& result, const Clock& clock);

}  // namespace edgeslam
