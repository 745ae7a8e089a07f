// A program that runs beside the test, its output in a file.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "unit/files/temporary_folder.h"
#include "unit/lcm/comes_true.h"

namespace edgeslam {

class BackgroundProcess {
 public:
  explicit BackgroundProcess(const std::vector<std::string>& command) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, folder_.path("said").c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                     0600);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    std::vector<std::string> words = command;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int error = posix_spawnp(&process_, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) throw std::runtime_error(command[0] + " cannot be started");
  }
  ~BackgroundProcess() { end(SIGKILL); }
  BackgroundProcess(const BackgroundProcess&) = delete;
  BackgroundProcess& operator=(const BackgroundProcess&) = delete;

  // Of both streams, as of now.
  std::string said() const { return fileContent(folder_.path("said")); }
  bool says(const std::string& text) const {
    return comesTrue([&] { return said().find(text) != std::string::npos; });
  }
  int times(const std::string& text) const {
    int count = 0;
    const std::string all = said();
    for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++count;
    return count;
  }

  // The exit code; -1 where it was ended by a signal, -2 where it does not end by itself.
  int exitCode() {
    int status = 0;
    if (!comesTrue([&] { return waitpid(process_, &status, WNOHANG) == process_; })) return -2;
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // That it used so far, all its threads together [s].
  double processorTime() const {
    clockid_t clock = 0;
    timespec used{};
    if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &used) != 0) return -1;
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  }
  void send(int signal) const { kill(process_, signal); }
  pid_t id() const { return process_; }
  void end(int signal) {
    if (process_ <= 0) return;
    kill(process_, signal);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  // Stopped, it holds its sockets and reads nothing.
  void freeze() const { kill(process_, SIGSTOP); }

 private:
  TemporaryFolder folder_;
  pid_t process_ = 0;
};

}  // namespace edgeslam
