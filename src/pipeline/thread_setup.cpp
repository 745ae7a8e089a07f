#include "pipeline/thread_setup.h"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>

namespace edgeslam {
namespace {

RefusedSetup refused(SetupKind kind, const std::string& thread, const std::string& what, int error) {
  return {kind, what + " of the thread " + thread + " (" + std::strerror(error) + ")"};
}

}  // namespace

std::optional<RefusedSetup> setUpThread(const ThreadSetup& setup) {
  std::optional<RefusedSetup> refusal;
  if (!setup.processors.empty()) {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    for (const int processor : setup.processors) CPU_SET(static_cast<std::size_t>(processor), &processors);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof(processors), &processors);
    if (error != 0) refusal = refused(SetupKind::processor, setup.name, "the processor", error);
  }
  sched_param parameters{};
  if (setup.real_time_priority > 0) {
    parameters.sched_priority = setup.real_time_priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error != 0) refusal = refused(SetupKind::scheduling, setup.name, "real-time priority", error);
  } else {
    const int error = pthread_setschedparam(pthread_self(), setup.batch ? SCHED_BATCH : SCHED_OTHER, &parameters);
    if (error != 0) refusal = refused(SetupKind::scheduling, setup.name, "usual or batch scheduling", error);
  }
  // On Linux a thread has a nice level of its own.
  if (setup.nice != 0 && setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), setup.nice) != 0) {
    refusal = refused(SetupKind::nice_level, setup.name, "the nice level", errno);
  }
  pthread_setname_np(pthread_self(), setup.name.substr(0, 15).c_str());
  return refusal;
}

std::optional<RefusedSetup> lockMemory() {
  // What is locked is filled as it is taken: what is let go stays for the next time.
  constexpr int most_kept = 32 << 20;  // [byte]
  mallopt(M_MMAP_THRESHOLD, most_kept);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return std::nullopt;
  return RefusedSetup{SetupKind::memory, std::string("locked memory (") + std::strerror(errno) + ")"};
}

}  // namespace edgeslam
