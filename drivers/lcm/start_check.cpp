#include "drivers/lcm/start_check.h"

#include <linux/capability.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <thread>

#include "drivers/lcm/lcm_options.h"
#include "pipeline/thread_setup.h"

namespace edgeslam {
namespace {

std::uint64_t effectiveCapabilities() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    std::uint64_t capabilities = 0;
    if (word == "CapEff:" && file >> std::hex >> capabilities) return capabilities;
  }
  return 0;
}

std::string megabytes(double bytes) { return std::to_string(static_cast<std::int64_t>(bytes / 1e6)) + " MB"; }

}  // namespace

std::vector<std::string> startProblems(const StartNeeds& needs) {
  std::vector<std::string> problems;
  const auto tell = [&](const std::string& problem) {
    if (!problem.empty()) problems.push_back(problem);
  };
  if (const auto group = multicastGroup(needs.lcm_url)) tell(multicastRouteProblem(*group));
  if (needs.real_time_priority > 0) tell(realTimeProblem(needs.real_time_priority));
  if (needs.lock_memory) tell(memoryLockProblem());
  if (!needs.folder.empty()) tell(freeDiskProblem(needs.folder, needs.free_bytes));
  return problems;
}

std::string realTimeProblem(int priority) {
  std::optional<RefusedSetup> refusal;
  std::thread trial([&] { refusal = setUpThread({"trial", priority, 0, false, {}}); });
  trial.join();
  if (!refusal) return "";
  const std::string wanted = std::to_string(priority);
  return "real-time priority " + wanted + " is not allowed, poses may come late; set LimitRTPRIO=" + wanted +
         " in the service, or `USER - rtprio " + wanted + "` in /etc/security/limits.conf";
}

std::string memoryLockProblem() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0) return "";
  return memoryLockProblem(limit.rlim_cur, effectiveCapabilities());
}

std::string memoryLockProblem(rlim_t limit_bytes, std::uint64_t capabilities) {
  const bool unlimited = limit_bytes == RLIM_INFINITY || (capabilities >> CAP_IPC_LOCK & 1) != 0;
  if (unlimited) return "";
  return "memory cannot be locked (the limit is " + megabytes(static_cast<double>(limit_bytes)) +
         "), poses may come late when memory runs short; set LimitMEMLOCK=infinity in the service, or `USER - memlock "
         "unlimited` in /etc/security/limits.conf";
}

std::string freeDiskProblem(const std::string& folder, std::int64_t needed_bytes) {
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) != 0) {
    return folder + ": " + std::strerror(errno) + "; maps and recordings go there: make the folder, or name another";
  }
  const double free_bytes = static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
  if (free_bytes >= static_cast<double>(needed_bytes)) return "";
  return folder + ": " + megabytes(free_bytes) + " are free, " + megabytes(static_cast<double>(needed_bytes)) +
         " are needed for maps and recordings; make room, or name another folder";
}

}  // namespace edgeslam
