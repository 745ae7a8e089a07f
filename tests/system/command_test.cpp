// How the command behaves towards the shell: what goes to which stream, and exit codes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace edgeslam {
namespace {

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string output;  // of both streams, unless redirected
};

Outcome runInShell(const std::string& arguments) {
  const std::string command = std::string(EDGESLAM_PROGRAM) + " " + arguments;
  FILE* pipe = popen(("exec 2>&1; " + command).c_str(), "r");
  if (!pipe) return {};
  Outcome outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

TEST(Command, TellsItsVersion) {
  const Outcome outcome = runInShell("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, "edgeslam " EDGESLAM_VERSION "\n");
}

TEST(Command, HelpNamesTheSubcommandsAndEachHasItsOwn) {
  const Outcome outcome = runInShell("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const std::string name :
       {"replay", "evaluate", "report", "benchmark", "simulate", "listen", "calibrate", "check-config"}) {
    EXPECT_NE(outcome.output.find("\n  " + name + " "), std::string::npos) << name;
    const Outcome help = runInShell(name + " --help");
    EXPECT_EQ(help.exit_code, 0) << name;
    EXPECT_NE(help.output.find("Usage: edgeslam " + name), std::string::npos) << help.output;
  }
}

TEST(Command, WrongUseIsOneLineAndExitCodeTwo) {
  for (const std::string arguments : {"", "fly", "--fly", "check-config", "check-config --fly", "check-config a b",
                                      "check-config a --print-default"}) {
    const Outcome outcome = runInShell(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.output.rfind("edgeslam: ", 0), 0U) << outcome.output;
    EXPECT_EQ(outcome.output.find('\n'), outcome.output.size() - 1) << outcome.output;
  }
}

TEST(Command, BadInputIsExitCodeTwo) {
  const Outcome outcome = runInShell("check-config /no/such/file");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.output, "/no/such/file: cannot be opened\n");
}

TEST(Command, AClosedPipeIsNoFailure) {
  // The reader is gone before the program starts; its exit code goes to the standard error.
  const std::string program = std::string(EDGESLAM_PROGRAM) + " check-config --print-default";
  const Outcome outcome = runInShell("--version | (cat; (sleep 0.3; " + program + "; echo $? >&2) | true)");
  EXPECT_EQ(outcome.output, "edgeslam " EDGESLAM_VERSION "\n0\n");
}

TEST(Command, AFullDiskBehindTheOutputIsTold) {
  const Outcome outcome = runInShell("check-config --print-default >/dev/full");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.output, "edgeslam: the standard output cannot be written (is the disk full?)\n");
}

}  // namespace
}  // namespace edgeslam
