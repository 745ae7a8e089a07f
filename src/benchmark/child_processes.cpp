#include "benchmark/child_processes.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// In the child, between fork and exec: only what is allowed there.
[[noreturn]] void become(char* const* arguments, int nothing, int log, pid_t parent) {
  constexpr int not_started = 127;
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(not_started);  // it died before that was set
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (dup2(nothing, STDIN_FILENO) < 0 || dup2(log, STDOUT_FILENO) < 0 || dup2(log, STDERR_FILENO) < 0)
    _exit(not_started);
  execv(arguments[0], arguments);
  _exit(not_started);
}

}  // namespace

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void ChildProcesses::start(std::size_t number, const std::vector<std::string>& command, const std::string& log_path) {
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int log = open(log_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (log < 0) throw InputError(log_path + ": cannot be written: " + std::strerror(errno));
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become(arguments.data(), nothing, log, parent);
  const int error = errno;
  close(log);
  if (nothing >= 0) close(nothing);
  if (child < 0) throw InputError(command[0] + ": cannot be started: " + std::strerror(error));
  children_[child] = {number, now_s()};
}

std::optional<RunEnd> ChildProcesses::takeEnded() {
  for (auto child = children_.begin(); child != children_.end(); ++child) {
    int status = 0;
    rusage used{};
    const pid_t ended = wait4(child->first, &status, WNOHANG, &used);
    if (ended == 0) continue;
    RunEnd end;
    end.number = child->second.number;
    if (ended > 0 && WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
    if (ended > 0 && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    end.wall_s = now_s() - child->second.start_s;
    end.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
    end.peak_mib = static_cast<double>(used.ru_maxrss) / 1024;
    children_.erase(child);
    return end;
  }
  return std::nullopt;
}

std::optional<RunEnd> ChildProcesses::waitForOne(double patience_s) {
  const double until_s = now_s() + patience_s;
  while (true) {
    std::optional<RunEnd> end = takeEnded();
    if (end || children_.empty() || now_s() >= until_s) return end;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void ChildProcesses::endAll() {
  constexpr double patience_s = 2;
  for (const auto& [process, child] : children_) kill(process, SIGTERM);
  const double until_s = now_s() + patience_s;
  while (!children_.empty() && now_s() < until_s) waitForOne(until_s - now_s());
  for (const auto& [process, child] : children_) kill(process, SIGKILL);
  while (!children_.empty()) waitForOne(1);
}

}  // namespace edgeslam
