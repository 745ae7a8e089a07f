// A calibration as text: the file that the program reads, and what people are told.
#pragma once

#include <string>

#include "calibration/calibration.h"
#include "calibration/coverage.h"

namespace edgeslam {

// camera.yaml, which readCalibration reads, with standard deviations and errors in comments. `source`: of the frames.
std::string calibrationFileText(const Calibration& calibration, const Board& board, const std::string& source);

// The result for people, several lines.
std::string calibrationSummary(const Calibration& calibration, const ViewCoverage& coverage);

}  // namespace edgeslam
