// What a benchmark's folder remembers of its runs, benchmark.json: which are finished and need not be run again, and
// why the others failed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/set_page.h"

namespace edgeslam {

constexpr const char* benchmark_record_name = "benchmark.json";

struct BenchmarkEntry {
  std::string name;         // of the sequence, and of the run's folder beside benchmark.json
  std::string input;        // absolute path of the sequence
  std::string fingerprint;  // of its files at the time (sequenceFingerprint)
  int exit_code = -1;       // of the run; -1: it was not run to its end
  std::string message;      // why it failed; empty where it has poses
  double cpu_s = 0, peak_mib = 0;
};

struct BenchmarkRecord {
  std::string source;  // the folder that was searched
  int jobs = 1;
  std::vector<BenchmarkEntry> entries;
};

// Throws InputError where it cannot be written.
void writeBenchmarkRecord(const std::string& folder, const BenchmarkRecord& record);

// Throws InputError with file and key where it is missing, damaged, or names what cannot be a run's folder.
BenchmarkRecord readBenchmarkRecord(const std::string& folder);

// True where `entry`'s run came to its end by itself, with this program version, this configuration in effect and these
// files of the sequence, and its summary is there.
bool isFinished(const std::string& folder, const BenchmarkEntry& entry, const std::string& fingerprint,
                const std::string& program_version, const std::string& configuration);

// The set of runs in a benchmark's folder, for a page in `page_folder`. A run whose files cannot be read is shown as
// failed with the reason.
RunSet setOfBenchmark(const std::string& folder, const BenchmarkRecord& record, const std::string& page_folder);

// The set of runs in these folders. Throws InputError where one of them holds no finished run.
RunSet setOfRuns(const std::vector<std::string>& folders, const std::string& page_folder);

}  // namespace edgeslam
