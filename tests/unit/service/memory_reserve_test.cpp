#include "service/memory_reserve.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace edgeslam {
namespace {

constexpr std::size_t mebibyte = 1 << 20;

// From now on this process gets `more` bytes, about, and no others.
void limitMemory(std::size_t more) {
  std::ifstream status("/proc/self/statm");
  std::size_t pages = 0;
  status >> pages;
  const rlimit limit{pages * 4096 + more, RLIM_INFINITY};
  setrlimit(RLIMIT_AS, &limit);
}

void expect(bool condition, int exit_code_without) {
  if (!condition) ::_exit(exit_code_without);
}

// Takes 20 MiB again and again by `take`, until there are none; ends the process with 0 where the reserve was of use.
template <typename Take>
[[noreturn]] void takeAll(Take take) {
  MemoryReserve reserve(32 * mebibyte);
  limitMemory(50 * mebibyte);
  expect(!reserve.isUsed(), 2);
  take();
  take();
  expect(!reserve.isUsed(), 3);
  take();
  expect(reserve.isUsed(), 4);
  try {
    for (int i = 0; i < 10; ++i) take();
  } catch (const std::exception&) {
    ::_exit(0);
  }
  ::_exit(5);
}

class MemoryReserveDeathTest : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take more memory than any limit";
#endif
    testing::FLAGS_gtest_death_test_style = "threadsafe";
  }
};

TEST_F(MemoryReserveDeathTest, WhatAsksForMoreThanThereIsGetsItOnce) {
  EXPECT_EXIT(takeAll([blocks = std::vector<std::string>()]() mutable { blocks.emplace_back(20 * mebibyte, 'x'); }),
              testing::ExitedWithCode(0), "");
}

TEST_F(MemoryReserveDeathTest, ImagesLikewise) {
  EXPECT_EXIT(takeAll([images = std::vector<cv::Mat>()]() mutable {
                images.emplace_back(20, static_cast<int>(mebibyte), CV_8U);
              }),
              testing::ExitedWithCode(0), "");
}

TEST(MemoryReserve, IsGoneWithItsEnd) {
  EXPECT_THROW(MemoryReserve(std::size_t{1} << 60), std::bad_alloc);
  { const MemoryReserve reserve(mebibyte); }
  const MemoryReserve again(mebibyte);
  EXPECT_FALSE(again.isUsed());
}

}  // namespace
}  // namespace edgeslam
