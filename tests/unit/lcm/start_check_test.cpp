#include "drivers/lcm/start_check.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <unistd.h>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

void expectAdvice(const std::string& problem, const std::string& what, const std::string& to_do) {
  EXPECT_NE(problem.find(what), std::string::npos) << problem;
  EXPECT_NE(problem.find(to_do), std::string::npos) << problem;
  EXPECT_EQ(problem.find('\n'), std::string::npos) << "one line";
}

TEST(StartCheck, MemoryMayBeLockedWithoutALimitOrWithThePermission) {
  EXPECT_EQ(memoryLockProblem(RLIM_INFINITY, 0), "");
  EXPECT_EQ(memoryLockProblem(8 << 20, std::uint64_t{1} << CAP_IPC_LOCK), "");
  expectAdvice(memoryLockProblem(8 << 20, ~(std::uint64_t{1} << CAP_IPC_LOCK)), "8 MB", "LimitMEMLOCK=infinity");
}

TEST(StartCheck, FreeDisk) {
  const TemporaryFolder folder;
  EXPECT_EQ(freeDiskProblem(folder.path(), 1), "");
  expectAdvice(freeDiskProblem(folder.path(), std::int64_t{1} << 62), folder.path(), "make room");
  expectAdvice(freeDiskProblem(folder.path("none"), 1), "No such file or directory", "make the folder");
}

// In a process of its own, that gives up its privileges.
TEST(StartCheck, RealTimePriorityWithoutPermission) {
  const auto check = [] {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_RTPRIO, &none);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(2);
    const std::string problem = realTimeProblem(60);
    _exit(problem.find("LimitRTPRIO=60") != std::string::npos ? 0 : 1);
  };
  EXPECT_EXIT(check(), testing::ExitedWithCode(0), "");
}

TEST(StartCheck, OnlyWhatIsNeededIsLookedAt) {
  StartNeeds needs;
  needs.lcm_url = "memq://";
  EXPECT_TRUE(startProblems(needs).empty());
  needs.folder = "/no/such/folder";
  ASSERT_EQ(startProblems(needs).size(), 1U);
  EXPECT_EQ(startProblems(needs)[0].rfind("/no/such/folder: ", 0), 0U);
}

}  // namespace
}  // namespace edgeslam
