// Memory over a long time in the same place: the map stays as it is, so the memory does.
#include <gtest/gtest.h>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

// To and fro, ten frames a second.
ReplayedRun walkToAndFro(const TemporaryFolder& folder, int frames) {
  const std::string hall = std::string(EDGESLAM_RUN_FOLDER) + "/hall";
  EditedSequence walk(1000, 10);
  while (walk.size() < frames) walk.add(hall, 0, 60).add(hall, 59, 1);
  const std::string name = std::to_string(frames);
  return replayed(walk.write(folder, "sequence" + name), folder.path("result" + name));
}

TEST(Memory, FiveTimesTheTimeInOnePlaceTakesNoMore) {
  const TemporaryFolder folder;
  const ReplayedRun once = walkToAndFro(folder, 240), five_times = walkToAndFro(folder, 1200);
  for (const ReplayedRun* run : {&once, &five_times}) {
    ASSERT_EQ(run->outcome.exit_code, 0) << run->outcome.messages;
    EXPECT_EQ(run->summary["states"]["lost"].get<int>(), 0);
    RecordProperty("peak_memory_kb_" + std::to_string(run->states.size()), std::to_string(run->outcome.peak_memory_kb));
  }
  EXPECT_LT(static_cast<double>(five_times.outcome.peak_memory_kb),
            1.1 * static_cast<double>(once.outcome.peak_memory_kb));
  EXPECT_LT(five_times.summary["keyframes"].get<double>(), 1.5 * once.summary["keyframes"].get<double>());
}

}  // namespace
}  // namespace edgeslam
