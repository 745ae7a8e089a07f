// Preloaded (LD_PRELOAD), it tells on the standard error in which libraries a program was that is ended by a signal.
#include <execinfo.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace {

constexpr int most_calls = 32;

void tellPlace(int signal) {
  std::array<void*, most_calls> calls{};
  backtrace_symbols_fd(calls.data(), backtrace(calls.data(), most_calls), STDERR_FILENO);
  raise(signal);
}

__attribute__((constructor)) void begin() {
  std::array<void*, 1> calls{};
  backtrace(calls.data(), 1);  // loads what it needs while there is memory
  struct sigaction action {};
  action.sa_handler = tellPlace;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) sigaction(signal, &action, nullptr);
}

}  // namespace
