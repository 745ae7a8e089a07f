#include "pipeline/semaphore.h"

#include <gtest/gtest.h>

#include <thread>

#include "pipeline/duration_statistics.h"

namespace edgeslam {
namespace {

TEST(Semaphore, WhatWasPostedIsWaitedForOnce) {
  Semaphore semaphore;
  semaphore.post();
  semaphore.post();
  semaphore.wait();
  semaphore.wait();
  const std::int64_t until_ns = steadyNow_ns() + 20'000'000;
  semaphore.waitUntil(until_ns);
  EXPECT_GE(steadyNow_ns(), until_ns) << "nothing was posted any more";
}

TEST(Semaphore, WakesTheThreadThatWaits) {
  Semaphore semaphore;
  std::thread other([&] { semaphore.post(); });
  semaphore.wait();
  other.join();
}

}  // namespace
}  // namespace edgeslam
