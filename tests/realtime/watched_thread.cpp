#include "realtime/watched_thread.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define EDGESLAM_WATCHES 0
#else
#define EDGESLAM_WATCHES 1
#endif

namespace {

enum Trespass { allocation, release, lock, system_call, kinds };

thread_local bool watched = false;
std::array<std::atomic<int>, kinds> counts{};
std::array<void*, 24> first_calls{};
std::atomic<int> first_depth{0};
std::array<char, 16> watched_name{};

void note(Trespass kind) {
  if (!watched) return;
  counts[kind].fetch_add(1);
  if (first_depth.load() == 0) {
    watched = false;
    first_depth.store(backtrace(first_calls.data(), static_cast<int>(first_calls.size())));
    watched = true;
  }
}

#if EDGESLAM_WATCHES

void onForbiddenCall(int, siginfo_t*, void* context) {
  note(system_call);
#if defined(__x86_64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RAX] = -ENOSYS;
#elif defined(__aarch64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.regs[0] = static_cast<unsigned long long>(-ENOSYS);
#endif
}

// Forbidden calls are not made, but end in SIGSYS. Those by which malloc gets its memory are counted as allocations.
void forbidSystemCalls() {
  struct sigaction action {};
  action.sa_sigaction = onForbiddenCall;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  constexpr unsigned allowed[] = {
      SYS_futex,           SYS_clock_gettime,  SYS_rt_sigreturn, SYS_exit, SYS_exit_group, SYS_madvise, SYS_munmap,
      SYS_restart_syscall, SYS_rt_sigprocmask, SYS_rseq,         SYS_mmap, SYS_mprotect,   SYS_brk};
  constexpr std::size_t count = sizeof(allowed) / sizeof(allowed[0]);
  std::array<sock_filter, count + 3> filter{};
  filter[0] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (std::size_t i = 0; i < count; ++i) {
    filter[i + 1] = BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed[i], static_cast<unsigned char>(count - i), 0);
  }
  filter[count + 1] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  filter[count + 2] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
    std::perror("system calls cannot be watched");
    std::abort();
  }
}

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

#endif

}  // namespace

#if EDGESLAM_WATCHES
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* memory);

void* malloc(size_t size) {
  note(allocation);
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  note(allocation);
  return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  note(allocation);
  return __libc_realloc(memory, size);
}
void* memalign(size_t alignment, size_t size) {
  note(allocation);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, size_t alignment, size_t size) {
  *memory = memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
void free(void* memory) {
  if (memory) note(release);
  __libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto original = next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  note(lock);
  return original(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static const auto original = next<int (*)(pthread_mutex_t*)>("pthread_mutex_trylock");
  note(lock);
  return original(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* mutex) {
  static const auto original = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  note(lock);
  return original(mutex);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* mutex) {
  static const auto original = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  note(lock);
  return original(mutex);
}

int pthread_setname_np(pthread_t thread, const char* name) {
  static const auto original = next<int (*)(pthread_t, const char*)>("pthread_setname_np");
  const int result = original(thread, name);
  if (watched_name[0] != 0 && std::strncmp(name, watched_name.data(), watched_name.size()) == 0) {
    watched_name[0] = 0;
    forbidSystemCalls();
    watched = true;
  }
  return result;
}
}
#endif

namespace edgeslam {

bool canWatchThreads() { return EDGESLAM_WATCHES != 0; }

void watchThreadNamed(const std::string& name) {
  std::array<void*, 4> calls{};
  backtrace(calls.data(), static_cast<int>(calls.size()));  // the first one loads a library
  takeTrespasses();
  std::strncpy(watched_name.data(), name.c_str(), watched_name.size() - 1);
}

Trespasses takeTrespasses() {
  Trespasses taken;
  taken.allocations = counts[allocation].exchange(0);
  taken.releases = counts[release].exchange(0);
  taken.locks = counts[lock].exchange(0);
  taken.system_calls = counts[system_call].exchange(0);
  const int depth = first_depth.exchange(0);
  if (depth > 0) {
    char** names = backtrace_symbols(first_calls.data(), depth);
    for (int i = 0; i < depth; ++i) taken.where.append(names[i]).append("\n");
    std::free(names);
  }
  return taken;
}

}  // namespace edgeslam
