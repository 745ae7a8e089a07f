// What a long run came to, minute by minute of the frames' time, and whether it stayed as it was.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace edgeslam {

struct SoakMinute {
  std::int64_t pass = 0;  // over all sequences, from 0
  std::string sequence;
  std::int64_t frames = 0;                                              // since the start
  double time_s = 0;                                                    // of the frames, since the start
  double wall_s = 0;                                                    // since the start
  double memory_mb = 0;                                                 // resident
  double processor_ms = 0;                                              // of the whole process, a frame of this minute
  double latency_50_ms = 0, latency_90_ms = 0, latency_99_ms = 0;       // from handing over to pose, in this minute
  double good_share = 0;                                                // of this minute's frames
  std::int64_t passed_over = 0, mapping_behind = 0, not_published = 0;  // since the run's start
  std::size_t keyframes = 0, points = 0;                                // of the map
};

// Heading and one line a minute.
std::string soakHeading();
std::string soakLine(const SoakMinute& minute);

// [MB] resident now.
double residentMegabytes();

// What did not stay as it was, a line each. The first pass fills caches and is not looked at. From then on:
// - memory: the most in the last third of the passes is at most 8 % and 16 MB over the most in the first third. What a
//   run keeps is bounded by the configuration (culling.most_keyframes, culling.most_megabytes), so after a pass over
//   all sequences there is nothing that may still grow. Of fewer than 10 passes it is not judged: runs with and without
//   a map take turns, and what the allocator keeps between them differs;
// - processor time a frame of each sequence, the median of the odd passes in the last third: at most 1.5 times that in
//   the first third (even ones start without a map, and so do something else);
// - median latency likewise at most 3 times: it is of the wall clock, and the machine may be busy.
std::vector<std::string> soakProblems(const std::vector<SoakMinute>& minutes);

}  // namespace edgeslam
