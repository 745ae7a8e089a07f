// Runs the program that was built, as a user's shell does, and keeps what it said.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "unit/files/temporary_folder.h"

namespace edgeslam {

struct Outcome {
  int exit_code = -1;    // -1: ended by a signal
  std::string output;    // standard output
  std::string messages;  // standard error
  long peak_memory_kb = 0;

  // Lines of the standard error that are a failure's message.
  std::vector<std::string> failures() const {
    std::vector<std::string> found;
    for (std::size_t at = 0; at < messages.size();) {
      const std::size_t end = std::min(messages.find('\n', at), messages.size());
      const std::string line = messages.substr(at, end - at);
      if (line.rfind("edgeslam: ", 0) == 0) found.push_back(line);
      at = end + 1;
    }
    return found;
  }
};

// `command[0]` is looked up in the PATH.
inline Outcome runCommand(const std::vector<std::string>& command) {
  const TemporaryFolder said;
  const std::string output = said.path("output"), messages = said.path("messages");
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT, 0600);
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error(command[0] + " cannot be started");
  int status = 0;
  rusage used{};
  while (wait4(process, &status, 0, &used) < 0 && errno == EINTR) continue;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, fileContent(output), fileContent(messages), used.ru_maxrss};
}

inline Outcome runProgram(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), EDGESLAM_PROGRAM);
  return runCommand(arguments);
}

// The program under `sh`, after the shell commands of `before`.
inline Outcome runProgramAfter(const std::string& before, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"sh", "-c", before + "; exec \"$0\" \"$@\"", EDGESLAM_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runCommand(command);
}

}  // namespace edgeslam
