// What is wrong with a recording that its user can mend, told by how the run over it went.
#pragma once

#include <string>

#include "pipeline/run_result.h"

namespace edgeslam {

// One line of all that applies, the worst first; empty where nothing does. Told are measurements that err over twice as
// far as a good camera's (median over the frames with a pose), over 5 % of frames rejected as blurred, and over 1 % of
// frame intervals longer than 2.5 times the median one. What is worst is furthest on the way from its limit to where a
// recording can hardly be used. Gaps are not looked for in a run that dropped frames itself.
std::string recordingQuality(const RunResult& result);

}  // namespace edgeslam
