#include "service/run_totals.h"

namespace edgeslam {

void RunTotals::end() {
  earlier_runs_ = counts();
  run_ = nullptr;
}

void RunTotals::frame(bool is_readable) {
  if (!is_readable) ++unreadable_;
}

void RunTotals::report(const MappingReport& report) {
  if (report.found) ++(report.found->how == TrackingState::recovered ? recoveries_ : relocalisations_);
  if (report.loop) ++loops_;
}

LiveCounts RunTotals::counts() const {
  LiveCounts counts = run_ ? run_->counts() : LiveCounts();
  counts.captured += earlier_runs_.captured;
  counts.processed += earlier_runs_.processed;
  counts.passed_over += earlier_runs_.passed_over;
  counts.mapping_behind += earlier_runs_.mapping_behind;
  counts.not_published += earlier_runs_.not_published;
  return counts;
}

void RunTotals::fill(PublisherStatus& status) const {
  const LiveCounts now = counts();
  status.frames_captured = now.captured;
  status.frames_dropped = now.passed_over;
  status.frames_unreadable = unreadable_;
  status.results_not_published = now.not_published;
  status.recoveries = recoveries_;
  status.relocalisations = relocalisations_;
  status.loops = loops_;
  status.mapping_queue = static_cast<int>(now.messages_waiting);
  status.publishing_queue = static_cast<int>(now.results_waiting);
  status.keyframes = static_cast<int>(now.keyframes);
  status.points = static_cast<int>(now.points);
}

}  // namespace edgeslam
