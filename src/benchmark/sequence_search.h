// Finds the sequences under a folder: TUM RGB-D, ICL-NUIM and EuRoC folders, recordings, and folders with a video or
// images and a calibration.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace edgeslam {

struct FoundSequence {
  std::string name;         // of its folder; where two would be called the same, with the folders above it: "day1_desk"
  std::string folder;       // absolute, links resolved
  std::string kind;         // "TUM RGB-D folder", ...; empty where it could not be opened
  std::int64_t frames = 0;  // 0: not known
  bool has_calibration = false;  // beside the frames
  std::string problem;           // why it could not be opened; a run over it will fail likewise
};

struct SearchLimits {
  int depth = 6;         // folders below the one given
  int folders = 100000;  // looked at in all
};

struct SequenceSearch {
  std::vector<FoundSequence> sequences;  // by name
  std::vector<std::string> notes;        // what was left out: folders that cannot be read, or lie too deep
};

// Looks at `folder` itself and below it, links to folders included, each folder once whatever links lead to it; not
// into sequences, not into hidden folders, not into `left_out` (where the results go). Throws InputError where `folder`
// is missing or is no folder, or where there are more folders than `limits` allows.
SequenceSearch findSequences(const std::string& folder, const std::string& left_out, const SearchLimits& limits = {});

// Changes when a file of the sequence is added, taken away, or written: its names, sizes and times of change.
std::string sequenceFingerprint(const std::string& folder);

}  // namespace edgeslam
