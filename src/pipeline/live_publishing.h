// What the publishing thread of a live run does: gives results and reports to whoever observes the run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/duration_statistics.h"
#include "pipeline/live_channels.h"

namespace edgeslam {

// Called by the publishing thread, in the order of the frames.
struct LiveObserver {
  std::function<void(const FrameResult&, const std::string& problem)> frame;  // `problem`: why it could not be read
  std::function<void(const MappingReport&)> report;
  std::function<void()> tick;  // each 100 ms or so, frames or not
};

class LivePublishing {
 public:
  // `channels` must outlive it.
  LivePublishing(LiveObserver observer, LiveChannels& channels);

  // The thread's work, until tracking and mapping have ended and all is given out.
  void run();

  // From any thread.
  void addDurations(std::vector<DurationSummary>& durations) const;

 private:
  bool publishOnce();
  bool isAtEnd() const;

  LiveObserver observer_;
  LiveChannels& channels_;
  DurationStatistics waiting_durations_, durations_;
};

}  // namespace edgeslam
