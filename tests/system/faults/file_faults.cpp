#include "system/faults/file_faults.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>

// Paths are taken as they are given, so that nothing is asked of the file system that the program did not ask.
namespace {

using edgeslam::Fault;
using edgeslam::FaultPlan;

enum class Step { make, write, sync, rename, remove, resize, close };

struct Plan {
  bool active = false;
  FaultPlan plan;
  int log = -1;
};

Plan& current() {
  static Plan plan;
  return plan;
}

std::atomic<long> steps{0};
thread_local bool inside = false;  // a step's own work is no step

void* original(const char* name) { return dlsym(RTLD_NEXT, name); }

template <typename Function>
Function* originalOf(Function* /*replaced*/, const char* name) {
  return reinterpret_cast<Function*>(original(name));
}

void take(const FaultPlan& plan) {
  Plan& now = current();
  now.active = false;
  if (now.log >= 0) syscall(SYS_close, now.log);
  now.log = -1;
  now.plan = plan;
  if (!plan.log.empty()) {
    const auto file = static_cast<int>(
        syscall(SYS_openat, AT_FDCWD, plan.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
    now.log = static_cast<int>(syscall(SYS_fcntl, file, F_DUPFD_CLOEXEC, 500));  // out of the way
    syscall(SYS_close, file);
  }
  steps = 0;
  now.active = !plan.under.empty();
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

__attribute__((constructor)) void takeFromEnvironment() {
  FaultPlan plan;
  plan.under = variable("EDGESLAM_FAULT_UNDER");
  if (plan.under.empty()) return;
  plan.fault = static_cast<Fault>(std::atoi(variable("EDGESLAM_FAULT").c_str()));
  plan.first = std::atol(variable("EDGESLAM_FAULT_FIRST").c_str());
  plan.while_exists = variable("EDGESLAM_FAULT_WHILE");
  plan.log = variable("EDGESLAM_FAULT_LOG");
  take(plan);
}

bool isUnder(const char* path) {
  const std::string& folder = current().plan.under;
  return path && std::strncmp(path, folder.c_str(), folder.size()) == 0 &&
         (path[folder.size()] == '/' || path[folder.size()] == '\0');
}

std::string pathOf(int file) {
  std::array<char, 40> link{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", file);
  std::array<char, PATH_MAX> path{};
  const ssize_t length = syscall(SYS_readlinkat, AT_FDCWD, link.data(), path.data(), path.size() - 1);
  return length > 0 ? std::string(path.data(), static_cast<std::size_t>(length)) : "";
}

std::string pathIn(int folder, const char* name) {
  if (folder == AT_FDCWD || (name && name[0] == '/')) return name ? name : "";
  return pathOf(folder) + "/" + (name ? name : "");
}

std::string sizeOf(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 ? std::to_string(status.st_size) : "0";
}

void cutPower() {
  syscall(SYS_kill, syscall(SYS_getpid), SIGKILL);
  while (true) pause();
}

// 0 or the errno with which this kind of step fails.
int errorOf(Fault fault, Step step) {
  switch (fault) {
    case Fault::no_space:
      return step == Step::make || step == Step::write || step == Step::sync || step == Step::rename ? ENOSPC : 0;
    case Fault::read_only:
      return step == Step::write || step == Step::close ? 0 : EROFS;
    case Fault::broken:
      return step == Step::write || step == Step::sync || step == Step::resize ? EIO : 0;
    default:
      return 0;
  }
}

void log(long number, const char* call, const std::string& path, const std::string& second) {
  const int file = current().log;
  if (file < 0) return;
  const std::string line = std::to_string(number) + " " + call + " " + path + " " + second + "\n";
  if (syscall(SYS_write, file, line.data(), line.size()) < 0) std::abort();
}

// Around one call: `act` does it, `half` does as much as is done when the power goes in its middle.
template <typename Act, typename Half>
auto stepped(const char* call, Step step, const std::string& path, const std::string& second, const Act& act,
             const Half& half) {
  const FaultPlan& plan = current().plan;
  if (!current().active || inside || !(isUnder(path.c_str()) || isUnder(second.c_str()))) return act();
  const long number = ++steps;
  if (plan.fault == Fault::cut_before && number == plan.first) cutPower();
  if (plan.fault == Fault::cut_within && number == plan.first) {
    half();
    cutPower();
  }
  const auto lasts = [&] {
    return plan.while_exists.empty() || syscall(SYS_faccessat, AT_FDCWD, plan.while_exists.c_str(), F_OK) == 0;
  };
  if (number >= plan.first && lasts()) {
    if (plan.fault == Fault::slow) usleep(50'000);
    while (plan.fault == Fault::stuck && lasts()) usleep(5'000);
    if (const int error = errorOf(plan.fault, step); error != 0) {
      log(number, "failed", path, call);
      errno = error;
      return static_cast<decltype(act())>(-1);
    }
  }
  inside = true;
  auto result = act();
  inside = false;
  const int error = errno;
  log(number, call, path, second);
  errno = error;
  return result;
}

template <typename Act>
auto stepped(const char* call, Step step, const std::string& path, const Act& act) {
  return stepped(call, step, path, "", act, act);
}

bool makes(int flags) { return (flags & (O_CREAT | O_TRUNC)) != 0; }

}  // namespace

namespace edgeslam {

void setFaults(const FaultPlan& plan) { take(plan); }
long faultSteps() { return steps; }

}  // namespace edgeslam

#define EDGESLAM_REPLACES extern "C" __attribute__((visibility("default")))

EDGESLAM_REPLACES int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = makes(flags) ? va_arg(more, mode_t) : 0;
  va_end(more);
  static auto* const real = originalOf(&open, "open");
  const auto act = [&] { return real(path, flags, mode); };
  return makes(flags) ? stepped("open", Step::make, path, act) : act();
}

EDGESLAM_REPLACES int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = makes(flags) ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open(path, flags, mode);
}

EDGESLAM_REPLACES int openat(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = makes(flags) ? va_arg(more, mode_t) : 0;
  va_end(more);
  static auto* const real = originalOf(&openat, "openat");
  const auto act = [&] { return real(folder, path, flags, mode); };
  return makes(flags) ? stepped("open", Step::make, pathIn(folder, path), act) : act();
}

EDGESLAM_REPLACES FILE* fopen(const char* path, const char* mode) {
  static auto* const real = originalOf(&fopen, "fopen");
  if (mode[0] == 'r') return real(path, mode);
  FILE* file = nullptr;
  const auto act = [&] { return (file = real(path, mode)) ? 0 : -1; };
  stepped("open", Step::make, path, act);
  return file;
}

EDGESLAM_REPLACES FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

EDGESLAM_REPLACES int mkostemp(char* name, int flags) {
  static auto* const real = originalOf(&mkostemp, "mkostemp");
  return stepped("open", Step::make, name, [&] { return real(name, flags); });
}

EDGESLAM_REPLACES int mkostemp64(char* name, int flags) { return mkostemp(name, flags); }

EDGESLAM_REPLACES ssize_t write(int file, const void* bytes, size_t size) {
  const auto part = [&](size_t count) { return syscall(SYS_write, file, bytes, count); };
  if (!current().active) return part(size);
  return stepped(
      "write", Step::write, pathOf(file), std::to_string(size), [&] { return part(size); },
      [&] { return part(size / 2); });
}

EDGESLAM_REPLACES ssize_t writev(int file, const iovec* parts, int count) {
  const auto some = [&](int some_parts) { return syscall(SYS_writev, file, parts, some_parts); };
  if (!current().active) return some(count);
  return stepped(
      "write", Step::write, pathOf(file), "0", [&] { return some(count); }, [&] { return some(count / 2); });
}

EDGESLAM_REPLACES ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  const auto part = [&](size_t some) { return syscall(SYS_pwrite64, file, bytes, some, at); };
  return stepped(
      "write", Step::write, pathOf(file), std::to_string(size), [&] { return part(size); },
      [&] { return part(size / 2); });
}

EDGESLAM_REPLACES int fsync(int file) {
  static auto* const real = originalOf(&fsync, "fsync");
  const auto act = [&] { return real(file); };
  return stepped("fsync", Step::sync, pathOf(file), sizeOf(file), act, act);
}

EDGESLAM_REPLACES int fdatasync(int file) {
  static auto* const real = originalOf(&fdatasync, "fdatasync");
  const auto act = [&] { return real(file); };
  return stepped("fsync", Step::sync, pathOf(file), sizeOf(file), act, act);
}

EDGESLAM_REPLACES int syncfs(int file) noexcept {
  static auto* const real = originalOf(&syncfs, "syncfs");
  return stepped("syncfs", Step::sync, pathOf(file), [&] { return real(file); });
}

EDGESLAM_REPLACES int ftruncate(int file, off_t length) noexcept {
  static auto* const real = originalOf(&ftruncate, "ftruncate");
  return stepped("resize", Step::resize, pathOf(file), [&] { return real(file, length); });
}

EDGESLAM_REPLACES int rename(const char* from, const char* to) noexcept {
  static auto* const real = originalOf(&rename, "rename");
  const auto act = [&] { return real(from, to); };
  return stepped("rename", Step::rename, from, to, act, act);
}

EDGESLAM_REPLACES int unlink(const char* path) noexcept {
  static auto* const real = originalOf(&unlink, "unlink");
  return stepped("remove", Step::remove, path, [&] { return real(path); });
}

EDGESLAM_REPLACES int unlinkat(int folder, const char* path, int flags) noexcept {
  static auto* const real = originalOf(&unlinkat, "unlinkat");
  return stepped("remove", Step::remove, pathIn(folder, path), [&] { return real(folder, path, flags); });
}

EDGESLAM_REPLACES int remove(const char* path) noexcept {
  static auto* const real = originalOf(&remove, "remove");
  return stepped("remove", Step::remove, path, [&] { return real(path); });
}

EDGESLAM_REPLACES int rmdir(const char* path) noexcept {
  static auto* const real = originalOf(&rmdir, "rmdir");
  return stepped("remove", Step::remove, path, [&] { return real(path); });
}

EDGESLAM_REPLACES int mkdir(const char* path, mode_t mode) noexcept {
  static auto* const real = originalOf(&mkdir, "mkdir");
  return stepped("mkdir", Step::make, path, [&] { return real(path, mode); });
}

EDGESLAM_REPLACES int close(int file) {
  const auto act = [&] { return static_cast<int>(syscall(SYS_close, file)); };
  if (!current().active) return act();
  return stepped("close", Step::close, pathOf(file), act);
}
