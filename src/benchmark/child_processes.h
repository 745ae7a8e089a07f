// Programs run beside this one, several at once, and what became of them.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/run_place.h"

namespace edgeslam {

double now_s();  // of a clock that is never set

// Children that still run when this is destroyed, or when this program dies, are ended with it. Each is in a process
// group of its own, so that Ctrl-C reaches this program alone.
class ChildProcesses : public RunPlace {
 public:
  ~ChildProcesses() override { endAll(); }

  void start(std::size_t number, const std::vector<std::string>& command, const std::string& log_path) override;
  std::size_t running() const override { return children_.size(); }
  bool isUnderWay(std::size_t) const override { return true; }
  std::optional<RunEnd> waitForOne(double patience_s) override;

  // SIGTERM to all, SIGKILL to those that are still there after two seconds.
  void endAll();

 private:
  struct Child {
    std::size_t number = 0;
    double start_s = 0;
  };
  std::optional<RunEnd> takeEnded();

  std::map<pid_t, Child> children_;
};

}  // namespace edgeslam
