// Where the runs of a benchmark go on: beside this program (child_processes.h) or on a cluster (slurm_array.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace edgeslam {

struct RunEnd {
  std::size_t number = 0;  // as given at the start
  int exit_code = -1;      // -1: ended by a signal, or see `problem`
  int signal = 0;
  double wall_s = 0, cpu_s = 0, peak_mib = 0;
  std::string problem;  // why nothing is known of its end; empty where it is
};

class RunPlace {
 public:
  RunPlace() = default;
  virtual ~RunPlace() = default;
  RunPlace(const RunPlace&) = delete;
  RunPlace& operator=(const RunPlace&) = delete;

  // `command[0]` is the program's path. Both of its outputs go to `log_path`, which is replaced. Throws InputError
  // where it cannot be started.
  virtual void start(std::size_t number, const std::vector<std::string>& command, const std::string& log_path) = 0;

  // Started, and its end not yet given.
  virtual std::size_t running() const = 0;

  // False while it waits for its turn.
  virtual bool isUnderWay(std::size_t number) const = 0;

  // A run that has ended, or nothing after `patience_s`. Throws InputError where the place takes no runs.
  virtual std::optional<RunEnd> waitForOne(double patience_s) = 0;
};

}  // namespace edgeslam
