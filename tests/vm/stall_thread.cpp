// Stops one thread of another program, as a deadlock would, until that program ends; for the watchdog's check.
//
// usage: stall_thread PROCESS THREAD_NAME
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

namespace {

// 0: there is none of that name.
pid_t threadNamed(const std::string& process, const std::string& name) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + process + "/task")) {
    std::string line;
    std::getline(std::ifstream(entry.path() / "comm"), line);
    if (line == name) return std::atoi(entry.path().filename().c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: stall_thread PROCESS THREAD_NAME\n";
    return 2;
  }
  const pid_t thread = threadNamed(argv[1], argv[2]);
  if (thread == 0 || ptrace(PTRACE_ATTACH, thread, nullptr, nullptr) != 0) {
    std::cerr << "stall_thread: " << argv[2] << ": " << (thread == 0 ? "no such thread" : std::strerror(errno)) << "\n";
    return 1;
  }
  int status = 0;
  while (waitpid(thread, &status, __WALL) == thread && WIFSTOPPED(status)) {
    std::cout << argv[2] << " is stopped" << std::endl;
  }
  return 0;
}
