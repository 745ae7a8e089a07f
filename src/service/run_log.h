// What the log is told of a run as it goes: changes of its state, changes of its world, messages that do not
// go out, over LCM or to ROS 2, and what mapping found.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/messages.h"
#include "service/event_log.h"

namespace edgeslam {

// For the publishing thread.
class RunLog {
 public:
  // `log` outlives it.
  explicit RunLog(EventLog& log) : log_(log) {}

  // Loops, frames that were found again, and what is to be configured otherwise.
  void report(const MappingReport& report);
  // The camera is in another world from this frame on.
  void tellWorld(std::int64_t frame_index, const std::string& change);
  // A line of what goes to ROS 2.
  void tellRos2(const std::string& line) { log_.tell(line); }
  // Each second, so that there is at most a line of each kind a second. Empty `state`: none to tell; empty
  // `lcm_problem`: messages go out.
  void tellChanges(const std::string& state, const std::string& lcm_problem);

 private:
  EventLog& log_;
  std::string told_state_, told_lcm_problem_;  // last
};

}  // namespace edgeslam
