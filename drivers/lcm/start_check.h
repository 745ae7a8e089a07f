// What usually goes wrong before the first pose: each a line that says what to do.
#pragma once

#include <sys/resource.h>

#include <cstdint>
#include <string>
#include <vector>

namespace edgeslam {

struct StartNeeds {
  std::string lcm_url;         // from effectiveUrl()
  int real_time_priority = 0;  // the highest that any thread asks for, 1 to 99; 0: none
  bool lock_memory = false;
  std::string folder;                   // where maps and recordings go; empty: nothing is written
  std::int64_t free_bytes = 100000000;  // that are needed there
};

// Empty where all is well. Changes nothing but the priority of a thread that it starts and ends.
std::vector<std::string> startProblems(const StartNeeds& needs);

// Each empty where all is well.
std::string realTimeProblem(int priority);
std::string memoryLockProblem();
std::string freeDiskProblem(const std::string& folder, std::int64_t needed_bytes);

// `limit_bytes`: RLIMIT_MEMLOCK; `capabilities`: of the process, CapEff of /proc/self/status. Locking memory under a
// limit would make later allocations fail: only without one it is allowed.
std::string memoryLockProblem(rlim_t limit_bytes, std::uint64_t capabilities);

}  // namespace edgeslam
