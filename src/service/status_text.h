// How a run is doing, in words for those who read the log or ask the service manager.
#pragma once

#include <string>

#include "drivers/lcm/status_message.h"
#include "pipeline/run_result.h"

namespace edgeslam {

// What matters of a frame's state in the log; empty for a state of one frame, which is told where it stays.
std::string logText(TrackingState state, const std::string& reason);

// One line for `systemctl status`; `with_gaps`: of the recording.
std::string serviceText(const PublisherStatus& status, TrackingState state, bool with_gaps);

}  // namespace edgeslam
