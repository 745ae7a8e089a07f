// What a replay came to, in a few lines on standard output.
#pragma once

#include <optional>
#include <string>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"

namespace edgeslam {

// What a person wants to know first; `output` is the folder that has the rest.
void tellOutcome(const RunResult& result, const std::optional<Trajectory>& ground_truth, const std::string& output);

}  // namespace edgeslam
