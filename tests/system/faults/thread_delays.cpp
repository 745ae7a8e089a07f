// Threads that are held up at random, as on a machine that has other work: preloaded (LD_PRELOAD), it sleeps before
// some of the calls of a thread that lie beside the queues: the steady clock, which every sender reads before it sends
// and every receiver after it has received; semaphores; mutexes. EDGESLAM_DELAY_SEED says which.
#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace {

constexpr std::uint32_t one_in = 24;
constexpr long longest_ns = 20'000'000;

std::atomic<std::uint32_t> threads{0};
thread_local std::uint64_t random_state = 0;
thread_local bool inside = false;

std::uint64_t seed() {
  static const std::uint64_t value = [] {
    const char* text = std::getenv("EDGESLAM_DELAY_SEED");
    return text ? std::strtoull(text, nullptr, 10) : 0;
  }();
  return value;
}

// xorshift64*
std::uint32_t nextRandom() {
  if (random_state == 0) random_state = (seed() + 1) * 0x9E3779B97F4A7C15ULL + ++threads;
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return static_cast<std::uint32_t>((random_state * 0x2545F4914F6CDD1DULL) >> 32);
}

void maybeSleep() {
  if (inside || seed() == 0) return;
  inside = true;
  if (nextRandom() % one_in == 0) {
    // Short ones more often than long ones.
    const double share = static_cast<double>(nextRandom() % 1000) / 1000;
    const timespec time{0, static_cast<long>(share * share * share * longest_ns)};
    syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, 0, &time, nullptr);
  }
  inside = false;
}

template <typename Function>
Function* original(Function* /*replaced*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define EDGESLAM_REPLACES extern "C" __attribute__((visibility("default")))

EDGESLAM_REPLACES int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock == CLOCK_MONOTONIC) maybeSleep();
  return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
}

EDGESLAM_REPLACES int sem_post(sem_t* semaphore) noexcept {
  static auto* const real = original(&sem_post, "sem_post");
  maybeSleep();
  return real(semaphore);
}

EDGESLAM_REPLACES int sem_wait(sem_t* semaphore) {
  static auto* const real = original(&sem_wait, "sem_wait");
  const int result = real(semaphore);
  maybeSleep();
  return result;
}

EDGESLAM_REPLACES int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = original(&pthread_mutex_lock, "pthread_mutex_lock");
  maybeSleep();
  return real(mutex);
}
