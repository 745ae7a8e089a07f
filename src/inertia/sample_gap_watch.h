// Where samples of an inertial unit are missing for so long that nothing is known of the motion meanwhile.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam {

// Between two samples, longer than InertialHistory::longest_gap_s.
struct SampleGap {
  std::int64_t end_ns = 0;
  double seconds = 0;
};

class SampleGapWatch {
 public:
  // As they come; a clock that is set back makes no gap.
  void add(std::int64_t time_ns);

  // In a line, of the last 10 s; empty where nothing was missing.
  std::string problem() const;

 private:
  std::deque<SampleGap> gaps_;  // of the last 10 s
  std::int64_t time_ns_ = -1;   // of the last sample
};

// Of a recording; empty where nothing is missing. Ascending times.
std::string sampleGapProblem(const std::vector<InertialSample>& samples);

}  // namespace edgeslam
