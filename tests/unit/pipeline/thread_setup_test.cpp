// What the system does not allow, and of what kind it is.
#include "pipeline/thread_setup.h"

#include <gtest/gtest.h>

#include <thread>

namespace edgeslam {
namespace {

std::optional<RefusedSetup> setUpAnother(const ThreadSetup& setup) {
  std::optional<RefusedSetup> refusal;
  std::thread([&] { refusal = setUpThread(setup); }).join();
  return refusal;
}

TEST(ThreadSetup, TheUsualOneIsAllowed) { EXPECT_FALSE(setUpAnother({"usual", 0, 0, false, {}})); }

TEST(ThreadSetup, AProcessorThatIsNotThereIsTold) {
  const std::optional<RefusedSetup> refusal = setUpAnother({"far", 0, 0, false, {1023}});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->kind, SetupKind::processor);
  EXPECT_EQ(refusal->text, "the processor of the thread far (Invalid argument)");
}

TEST(ThreadSetup, APriorityThatIsNoneIsTold) {
  const std::optional<RefusedSetup> refusal = setUpAnother({"high", 1000, 0, false, {}});
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->kind, SetupKind::scheduling);
  EXPECT_EQ(refusal->text, "real-time priority of the thread high (Invalid argument)");
}

}  // namespace
}  // namespace edgeslam
