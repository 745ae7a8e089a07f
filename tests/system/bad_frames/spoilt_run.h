// What holds of every run over a spoilt sequence, as a base for test fixtures.
#pragma once

#include <string>
#include <vector>

#include "system/bad_frames/measured_poses.h"
#include "system/bad_frames/spoilt_sequence.h"
#include "system/run_result.h"

namespace edgeslam {

struct Spoilt {
  ReplayedRun run;
  std::vector<MeasuredPose> good;
  Honesty honesty;
};

class SpoiltRun {
 protected:
  static constexpr int length = 240;  // [frames], 30 a second
  static constexpr int fault = 150;   // the first bad frame, unless a test says otherwise

  // A place that ctest's fixtures simulate.
  explicit SpoiltRun(const std::string& place) : sequence_(folderOf(place), length) {}

  static std::string folderOf(const std::string& place);

  // Runs over the sequence: the program does not fail, and this share at least of the poses said to be good lie within
  // the uncertainty stated with them.
  Spoilt run(double least_share_within = 0.99);

  // Good again within so many frames from `first` on, and nearly always from then on.
  static void expectGoodWithin(const Spoilt& result, int first, int frames);

  static void expectNoneGood(const Spoilt& result, int first, int last);

  SpoiltSequence sequence_;

 private:
  const TemporaryFolder folder_;
};

}  // namespace edgeslam
