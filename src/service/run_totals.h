// What is counted since the start of the program, over all its runs.
#pragma once

#include <cstdint>

#include "drivers/lcm/status_message.h"
#include "pipeline/live_run.h"

namespace edgeslam {

// For the publishing thread; between two runs, for the one that starts and ends them.
class RunTotals {
 public:
  // `run` lasts until end().
  void begin(const LiveRun& run) { run_ = &run; }
  void end();

  void frame(bool is_readable);
  void report(const MappingReport& report);

  // Counters of the runs before are in; what is of now is of this run.
  LiveCounts counts() const;
  // The counters of `status`; of the dropped frames, those that tracking passed over.
  void fill(PublisherStatus& status) const;

 private:
  const LiveRun* run_ = nullptr;  // null between two runs
  LiveCounts earlier_runs_;
  std::int64_t unreadable_ = 0;
  int recoveries_ = 0, relocalisations_ = 0, loops_ = 0;
};

}  // namespace edgeslam
