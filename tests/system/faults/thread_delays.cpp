// Threads that are held up at random, as on a machine that has other work: preloaded (LD_PRELOAD), it sleeps at the
// first and at some other calls of a thread that lie beside the queues: the steady clock, which every sender reads
// before it sends and every receiver after it has received; semaphores; mutexes. EDGESLAM_DELAY_SEED says which. At the
// end the file EDGESLAM_DELAY_REPORT gets a line for each thread and call: "THREAD CALL CALLS DELAYS".
#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::uint32_t one_in = 12;
constexpr long longest_ns = 20'000'000;
constexpr std::size_t kinds = 5;
constexpr std::array<const char*, kinds> calls{"clock_gettime", "sem_post", "sem_wait", "sem_clockwait",
                                               "pthread_mutex_lock"};

// Of one thread, written by it alone.
struct Counts {
  std::array<char, 16> name{};
  std::array<std::atomic<long>, kinds> calls{}, delays{};
};

std::array<Counts, 64> counts;
std::atomic<std::uint32_t> threads{0};
thread_local Counts* own_counts = nullptr;
thread_local std::uint64_t random_state = 0;
thread_local bool inside = false;

std::uint64_t seed() {
  static const std::uint64_t value = [] {
    const char* text = std::getenv("EDGESLAM_DELAY_SEED");
    return text ? std::strtoull(text, nullptr, 10) : 0;
  }();
  return value;
}

void beginThread() {
  const std::uint32_t number = threads++;
  own_counts = &counts[std::min<std::size_t>(number, counts.size() - 1)];
  random_state = (seed() + 1) * 0x9E3779B97F4A7C15ULL + number;
}

// xorshift64*
std::uint32_t nextRandom() {
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return static_cast<std::uint32_t>((random_state * 0x2545F4914F6CDD1DULL) >> 32);
}

void maybeSleep(std::size_t kind) {
  if (inside || seed() == 0) return;
  inside = true;
  const bool is_first = own_counts == nullptr;
  if (is_first) beginThread();
  ++own_counts->calls[kind];
  if (nextRandom() % one_in == 0 || is_first) {
    ++own_counts->delays[kind];
    prctl(PR_GET_NAME, own_counts->name.data());
    // Short ones more often than long ones.
    const double share = static_cast<double>(nextRandom() % 1000) / 1000;
    const timespec time{0, static_cast<long>(share * share * share * longest_ns)};
    syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, &time, nullptr);
  }
  inside = false;
}

__attribute__((destructor)) void report() {
  const char* path = std::getenv("EDGESLAM_DELAY_REPORT");
  FILE* file = path ? std::fopen(path, "a") : nullptr;
  if (!file) return;
  for (const Counts& thread : counts) {
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      if (thread.calls[kind] == 0) continue;
      std::fprintf(file, "%s %s %ld %ld\n", thread.name.data(), calls[kind], thread.calls[kind].load(),
                   thread.delays[kind].load());
    }
  }
  std::fclose(file);
}

template <typename Function>
Function* original(Function* /*replaced*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define EDGESLAM_REPLACES extern "C" __attribute__((visibility("default")))

EDGESLAM_REPLACES int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock == CLOCK_MONOTONIC) maybeSleep(0);
  return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
}

EDGESLAM_REPLACES int sem_post(sem_t* semaphore) noexcept {
  static auto* const real = original(&sem_post, "sem_post");
  maybeSleep(1);
  return real(semaphore);
}

EDGESLAM_REPLACES int sem_wait(sem_t* semaphore) {
  static auto* const real = original(&sem_wait, "sem_wait");
  const int result = real(semaphore);
  maybeSleep(2);
  return result;
}

EDGESLAM_REPLACES int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* until) {
  static auto* const real = original(&sem_clockwait, "sem_clockwait");
  const int result = real(semaphore, clock, until);
  const int error = errno;
  maybeSleep(3);
  errno = error;
  return result;
}

EDGESLAM_REPLACES int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = original(&pthread_mutex_lock, "pthread_mutex_lock");
  maybeSleep(4);
  return real(mutex);
}
