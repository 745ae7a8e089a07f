// Runs `edgeslam replay` over a set of sequences, several at once, each in a folder of its own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmark/benchmark_record.h"
#include "benchmark/run_place.h"
#include "benchmark/sequence_search.h"

namespace edgeslam {

struct PlannedRun {
  FoundSequence sequence;
  std::string fingerprint;         // of the sequence's files
  std::string configuration_path;  // for replay's --config; empty: none
  bool is_finished = false;        // by an earlier benchmark: not run again
};

struct BenchmarkPlan {
  std::string program;  // path of `edgeslam`
  std::string output;   // folder for the runs and benchmark.json
  int jobs = 1;         // runs at once
  std::vector<PlannedRun> runs;
};

// What is going on, for a line of progress.
struct BenchmarkProgress {
  std::size_t total = 0, done = 0, failed = 0;  // `done` includes what failed and what was finished before
  std::vector<std::string> running;             // names of the sequences
  std::optional<double> left_s;                 // once a run has ended
};

// "3 of 8 done (1 failed), running desk, xyz; about 2 min left".
std::string formatProgress(const BenchmarkProgress& progress);

// Why a run failed: its last message, or how it ended. `log` is what it said.
std::string failureMessage(const RunEnd& end, const std::string& log, const std::string& log_path);

// How the one who waits is told.
struct BenchmarkListener {
  std::function<bool()> stop;                           // asked ten times a second; true ends the children
  std::function<void(const BenchmarkProgress&)> going;  // ten times a second
  std::function<void(const PlannedRun&, const BenchmarkEntry&)> ended;
};

// Brings `record` up to date after each run and writes it; entries of sequences that are not planned stay as they are.
// False where it was stopped before all were run. Throws InputError where a folder cannot be made or written.
bool runBenchmark(const BenchmarkPlan& plan, BenchmarkRecord& record, const BenchmarkListener& listener);

// The same at another place than beside this program.
bool runBenchmark(const BenchmarkPlan& plan, BenchmarkRecord& record, const BenchmarkListener& listener,
                  RunPlace& place);

}  // namespace edgeslam
