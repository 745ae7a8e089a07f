#include "service/run_totals.h"

#include "unit/service/made_service.h"

namespace edgeslam {
namespace {

using RunTotalsTest = MadeService;

TEST_F(RunTotalsTest, GoOnOverRuns) {
  RunTotals totals;
  totals.begin(run_);
  run_.handOver();
  run_.handOver();
  totals.frame(/*is_readable=*/false);
  totals.end();
  LiveRun next(smallCamera(), Settings(), LiveOptions(), LiveObserver(), nullptr);
  totals.begin(next);
  next.handOver();
  totals.frame(/*is_readable=*/true);
  PublisherStatus status;
  totals.fill(status);
  EXPECT_EQ(status.frames_captured, 3);
  EXPECT_EQ(status.frames_unreadable, 1);
  EXPECT_EQ(status.keyframes, 0);
}

TEST_F(RunTotalsTest, FoundFramesAndLoopsAreCountedByKind) {
  RunTotals totals;
  MappingReport report;
  report.found = MappingReport::Found();
  report.found->how = TrackingState::recovered;
  totals.report(report);
  report.found->how = TrackingState::relocalised;
  report.loop = ClosedLoop();
  totals.report(report);
  totals.report(report);
  PublisherStatus status;
  totals.fill(status);
  EXPECT_EQ(status.recoveries, 1);
  EXPECT_EQ(status.relocalisations, 2);
  EXPECT_EQ(status.loops, 2);
  EXPECT_EQ(status.frames_captured, 0) << "before the first run";
}

}  // namespace
}  // namespace edgeslam
