// Programs run beside this one, several at once, and what became of them.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace edgeslam {

struct ChildEnd {
  std::size_t number = 0;  // as given at the start
  int exit_code = -1;      // -1: ended by a signal
  int signal = 0;
  double wall_s = 0, cpu_s = 0, peak_mib = 0;
};

// Children that still run when this is destroyed, or when this program dies, are ended with it.
class ChildProcesses {
 public:
  ChildProcesses() = default;
  ~ChildProcesses() { endAll(); }
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;

  // `command[0]` is the program's path. Both of its outputs go to `log_path`, which is replaced. It is in a process
  // group of its own, so that Ctrl-C reaches this program alone. Throws InputError where it cannot be started.
  void start(std::size_t number, const std::vector<std::string>& command, const std::string& log_path);

  std::size_t running() const { return children_.size(); }

  // A child that has ended, or nothing after `patience_s`.
  std::optional<ChildEnd> waitForOne(double patience_s);

  // SIGTERM to all, SIGKILL to those that are still there after two seconds.
  void endAll();

 private:
  struct Child {
    std::size_t number = 0;
    double start_s = 0;
  };
  std::optional<ChildEnd> takeEnded();

  std::map<pid_t, Child> children_;
};

}  // namespace edgeslam
