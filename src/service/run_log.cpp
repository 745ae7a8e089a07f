#include "service/run_log.h"

namespace edgeslam {

void RunLog::report(const MappingReport& report) {
  if (!report.found && !report.loop && !report.is_of_setup) return;
  for (const std::string& event : report.events) {
    log_.tell("frame " + std::to_string(report.frame_index) + ": " + event);
  }
}

void RunLog::tellWorld(std::int64_t frame_index, const std::string& change) {
  log_.tell("frame " + std::to_string(frame_index) + ": " + change);
}

void RunLog::tellChanges(const std::string& state, const std::string& lcm_problem) {
  if (!state.empty() && state != told_state_) {
    told_state_ = state;
    log_.tell("state: " + state);
  }
  if (lcm_problem != told_lcm_problem_) {
    log_.tell(lcm_problem.empty() ? "messages go out again" : "messages do not go out: " + lcm_problem);
    told_lcm_problem_ = lcm_problem;
  }
}

}  // namespace edgeslam
