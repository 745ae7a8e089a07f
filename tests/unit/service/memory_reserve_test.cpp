#include "service/memory_reserve.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <Eigen/Core>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>
#include <thread>
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

TEST_F(MemoryReserveDeathTest, MatricesLikewise) {
  EXPECT_EXIT(takeAll([matrices = std::vector<Eigen::MatrixXd>()]() mutable {
                matrices.emplace_back(Eigen::MatrixXd::Zero(20, static_cast<int>(mebibyte / sizeof(double))));
              }),
              testing::ExitedWithCode(0), "");
}

// A library in C has each of these; what it is refused it tells by null.
template <typename Allocate>
void takenInC(Allocate allocate) {
  EXPECT_EXIT(takeAll([allocate] {
                if (allocate(20 * mebibyte) == nullptr) throw std::bad_alloc();
              }),
              testing::ExitedWithCode(0), "");
}

TEST_F(MemoryReserveDeathTest, WhatIsWrittenInCLikewise) {
  takenInC([](std::size_t bytes) { return std::malloc(bytes); });
  takenInC([](std::size_t bytes) { return std::calloc(bytes, 1); });
  takenInC([](std::size_t bytes) { return std::realloc(std::malloc(1), bytes); });
  takenInC([](std::size_t bytes) { return std::aligned_alloc(64, bytes); });
  takenInC([](std::size_t bytes) {
    void* memory = nullptr;
    return posix_memalign(&memory, 64, bytes) == 0 ? memory : nullptr;
  });
}

// Threads that are refused while the reserve is being given get of it as well. None of these blocks fits into what the
// C library has set aside for a thread.
TEST_F(MemoryReserveDeathTest, IsThereForEveryThreadThatIsRefusedAtOnce) {
  const auto all_take = [] {
    constexpr int count = 8;
    const MemoryReserve reserve((count + 2) * 100 * mebibyte);
    std::atomic<int> ready{0}, served{0};
    std::vector<std::thread> threads;
    threads.reserve(count);
    for (int i = 0; i < count; ++i) {
      threads.emplace_back([&] {
        void* volatile first = std::malloc(1);  // by which the thread gets what is set aside
        for (++ready; ready <= count;) std::this_thread::yield();
        std::free(first);
        void* volatile block = std::malloc(100 * mebibyte);
        if (block != nullptr) ++served;
      });
    }
    while (ready < count) std::this_thread::yield();
    limitMemory(0);
    ++ready;
    for (std::thread& thread : threads) thread.join();
    expect(reserve.isUsed(), 2);
    expect(served == count, 3);
    ::_exit(0);
  };
  for (int i = 0; i < 10; ++i) EXPECT_EXIT(all_take(), testing::ExitedWithCode(0), "");
}

TEST(MemoryReserve, AlignmentsThatAreNoneAreRefusedAsEver) {
  void* memory = nullptr;
  EXPECT_EQ(posix_memalign(&memory, 24, 100), EINVAL);
  EXPECT_EQ(posix_memalign(&memory, 4, 100), EINVAL);
  ASSERT_EQ(posix_memalign(&memory, 4096, 100), 0);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % 4096, 0U);
  std::free(memory);
}

TEST(MemoryReserve, IsGoneWithItsEnd) {
  EXPECT_THROW(MemoryReserve(std::size_t{1} << 60), std::bad_alloc);
  { const MemoryReserve reserve(mebibyte); }
  const MemoryReserve again(mebibyte);
  EXPECT_FALSE(again.isUsed());
}

}  // namespace
}  // namespace edgeslam
