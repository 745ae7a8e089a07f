// Runs as one job array of Slurm. A folder that all nodes share has a file for each task, and what became of it beside
// it; squeue is asked only for what left nothing.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "benchmark/child_processes.h"

namespace edgeslam {

struct SlurmSettings {
  std::string program;               // path of `edgeslam`, on all nodes
  std::string source, output;        // the benchmark's folders, for the tasks' command line
  std::vector<std::string> options;  // for sbatch, after ours
  int at_once = 0;                   // tasks at once; 0: as many as Slurm has room for
};

// The words of `text`, divided at blanks; quotes (' and ") keep blanks. Throws InputError where a quote stays open.
std::vector<std::string> slurmOptions(const std::string& text);

// Tasks that wait or run when this is destroyed are cancelled. All runs are to be started before the first wait, which
// hands them over.
class SlurmArray : public RunPlace {
 public:
  // Throws InputError where the options have an array of their own.
  explicit SlurmArray(const SlurmSettings& settings);
  ~SlurmArray() override;

  // Throws InputError where sbatch, squeue or scancel is not in the PATH, or the folder cannot be written.
  void start(std::size_t number, const std::vector<std::string>& command, const std::string& log_path) override;
  std::size_t running() const override { return tasks_.size(); }
  bool isUnderWay(std::size_t number) const override;
  // Throws InputError where sbatch refuses, or the nodes do not see the folder.
  std::optional<RunEnd> waitForOne(double patience_s) override;

  // Empty before it was handed over.
  const std::string& job() const { return job_; }
  // Of all that wait or run; false where there are none.
  bool cancel();

 private:
  struct Task {
    std::size_t number = 0;
    double gone_since_s = -1;  // when squeue first had it as ended; -1: it has not
    std::string state;         // as squeue has it
  };
  void submit();
  std::optional<RunEnd> takeEnded();
  void askForStates();
  void noteStates(const std::string& answer, bool is_known);
  RunEnd endWithoutResult(int index, const Task& task) const;
  std::string path(int index, const std::string& ending) const;

  SlurmSettings settings_;
  std::string sbatch_, squeue_, scancel_;
  std::string folder_;           // of the tasks' files
  std::map<int, Task> tasks_;    // by their numbers in the array
  std::set<std::string> files_;  // in the folder when last looked
  int started_ = 0;
  std::string job_;
  ChildProcesses asking_;  // squeue
  double asked_s_ = 0, looked_s_ = 0;
};

// One task of an array, on its node: runs what `task_path` says and leaves how it ended beside it. `stop` is asked ten
// times a second; a run that is stopped leaves nothing. Throws InputError where the file cannot be read or written.
bool runSlurmTask(const std::string& program, const std::string& task_path, const std::function<bool()>& stop);

}  // namespace edgeslam
