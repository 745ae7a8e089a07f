#include "benchmark/benchmark_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "benchmark/child_processes.h"
#include "benchmark/json_reader.h"
#include "report/run_files.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_log = std::size_t{64} << 20U;  // [bytes]

BenchmarkEntry& entryFor(BenchmarkRecord& record, const PlannedRun& run) {
  const auto found = std::find_if(record.entries.begin(), record.entries.end(),
                                  [&](const BenchmarkEntry& entry) { return entry.name == run.sequence.name; });
  if (found != record.entries.end()) return *found;
  BenchmarkEntry entry;
  entry.name = run.sequence.name;
  record.entries.push_back(entry);
  return record.entries.back();
}

// What an earlier run left is not to be taken for this one's.
void prepareFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder + ": cannot be made: " + error.message());
  for (const char* name : {"summary.json", "report.html", "frames.csv", "trajectory.txt", "trajectory_live.txt",
                           "keyframes.txt", "map.ply"}) {
    fs::remove(folder + "/" + name, error);
  }
  std::vector<fs::path> of_other_worlds;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (isFileOfAnotherWorld(entry.path().filename().string())) of_other_worlds.push_back(entry.path());
  }
  for (const fs::path& path : of_other_worlds) fs::remove(path, error);
}

std::string logOf(const std::string& path) {
  try {
    return readBoundedFile(path, longest_log);
  } catch (const InputError&) {
    return "";
  }
}

// One benchmark that is going on.
class Benchmark {
 public:
  Benchmark(const BenchmarkPlan& plan, BenchmarkRecord& record, const BenchmarkListener& listener, RunPlace& place)
      : plan_(plan), record_(record), listener_(listener), place_(place) {
    for (std::size_t i = 0; i < plan.runs.size(); ++i) {
      if (plan.runs[i].is_finished) {
        ++done_;
        if (entryFor(record, plan.runs[i]).exit_code != 0) ++failed_;
      } else {
        waiting_.push_back(i);
        BenchmarkEntry& entry = entryFor(record, plan.runs[i]);
        entry.input = plan.runs[i].sequence.folder;
        entry.fingerprint = plan.runs[i].fingerprint;
        entry.exit_code = -1;
        entry.message = "was not run to its end";
      }
    }
    std::reverse(waiting_.begin(), waiting_.end());
    writeBenchmarkRecord(plan.output, record);
  }

  bool run() {
    constexpr double patience_s = 0.1;
    while (!waiting_.empty() || place_.running() > 0) {
      if (listener_.stop()) return false;
      while (!waiting_.empty() && static_cast<int>(place_.running()) < plan_.jobs) startNext();
      const std::optional<RunEnd> end = place_.waitForOne(patience_s);
      if (end) note(*end);
      listener_.going(progress());
    }
    return true;
  }

 private:
  void startNext() {
    const std::size_t number = waiting_.back();
    waiting_.pop_back();
    const PlannedRun& run = plan_.runs[number];
    const std::string folder = plan_.output + "/" + run.sequence.name;
    prepareFolder(folder);
    std::vector<std::string> command{plan_.program, "replay", run.sequence.folder, "--output", folder};
    if (!run.configuration_path.empty()) {
      command.emplace_back("--config");
      command.push_back(run.configuration_path);
    }
    place_.start(number, command, folder + "/run.log");
    running_.push_back(number);
  }

  void note(const RunEnd& end) {
    const PlannedRun& run = plan_.runs[end.number];
    running_.erase(std::find(running_.begin(), running_.end(), end.number));
    BenchmarkEntry& entry = entryFor(record_, run);
    const std::string log_path = plan_.output + "/" + run.sequence.name + "/run.log";
    entry.exit_code = end.exit_code < 0 ? 255 : end.exit_code;
    entry.message = end.exit_code == 0 ? "" : failureMessage(end, logOf(log_path), run.sequence.name + "/run.log");
    entry.cpu_s = end.cpu_s, entry.peak_mib = end.peak_mib;
    ++done_;
    if (end.exit_code != 0) ++failed_;
    if (end.exit_code == 0) {
      timed_frames_ += static_cast<double>(run.sequence.frames);
      timed_s_ += end.wall_s;
    }
    writeBenchmarkRecord(plan_.output, record_);
    listener_.ended(run, entry);
  }

  BenchmarkProgress progress() const {
    BenchmarkProgress progress;
    progress.total = plan_.runs.size();
    progress.done = done_, progress.failed = failed_;
    for (const std::size_t number : running_) {
      if (place_.isUnderWay(number)) progress.running.push_back(plan_.runs[number].sequence.name);
    }
    if (timed_frames_ <= 0) return progress;
    double frames = 0;  // of the running ones half, on average
    for (const std::size_t number : running_) {
      const double left = place_.isUnderWay(number) ? 0.5 : 1;
      frames += left * static_cast<double>(plan_.runs[number].sequence.frames);
    }
    for (const std::size_t number : waiting_) frames += static_cast<double>(plan_.runs[number].sequence.frames);
    const std::size_t at_once = std::max(progress.running.size(), std::size_t{1});
    progress.left_s = frames * timed_s_ / timed_frames_ / static_cast<double>(at_once);
    return progress;
  }

  const BenchmarkPlan& plan_;
  BenchmarkRecord& record_;
  const BenchmarkListener& listener_;
  RunPlace& place_;
  std::vector<std::size_t> waiting_, running_;  // numbers in the plan, the next one last
  std::size_t done_ = 0, failed_ = 0;
  double timed_frames_ = 0, timed_s_ = 0;  // of the runs that ended well
};

}  // namespace

std::string formatProgress(const BenchmarkProgress& progress) {
  std::string line = std::to_string(progress.done) + " of " + std::to_string(progress.total) + " done";
  if (progress.failed > 0) line += " (" + std::to_string(progress.failed) + " failed)";
  for (std::size_t i = 0; i < progress.running.size(); ++i)
    line += (i == 0 ? ", running " : ", ") + progress.running[i];
  if (progress.left_s) {
    const double left_s = *progress.left_s;
    const bool in_minutes = left_s >= 90;
    line += "; about " + std::to_string(std::llround(std::ceil(in_minutes ? left_s / 60 : left_s))) +
            (in_minutes ? " min left" : " s left");
  }
  return line;
}

std::string failureMessage(const RunEnd& end, const std::string& log, const std::string& log_path) {
  if (!end.problem.empty()) return end.problem;
  if (end.exit_code < 0) {
    return std::string("ended by signal ") + std::to_string(end.signal) + " (" + strsignal(end.signal) + "); see " +
           log_path;
  }
  const std::string own = "edgeslam: ", no_pose = "no pose: ";
  std::string message;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const bool is_skipped_frame = line.rfind(own + "frame ", 0) == 0;
    if (line.rfind(own, 0) == 0 && !is_skipped_frame) message = line.substr(own.size());
    if (line.rfind(no_pose, 0) == 0) message = line;
  }
  if (message.empty()) message = "ended with exit code " + std::to_string(end.exit_code) + "; see " + log_path;
  return message;
}

bool runBenchmark(const BenchmarkPlan& plan, BenchmarkRecord& record, const BenchmarkListener& listener) {
  ChildProcesses children;
  return runBenchmark(plan, record, listener, children);
}

bool runBenchmark(const BenchmarkPlan& plan, BenchmarkRecord& record, const BenchmarkListener& listener,
                  RunPlace& place) {
  return Benchmark(plan, record, listener, place).run();
}

}  // namespace edgeslam
