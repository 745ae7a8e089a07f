#include "service/outside_thread.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <future>
#include <memory>
#include <vector>

namespace edgeslam {
namespace {

TEST(OutsideThread, HandsOnInOrder) {
  std::vector<int> taken;
  {
    OutsideThread outside;
    for (int i = 0; i < 40; ++i) EXPECT_TRUE(outside.hand([&taken, i] { taken.push_back(i); }));
    ASSERT_TRUE(outside.waitUntilTaken());
  }
  ASSERT_EQ(taken.size(), 40u);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(taken[static_cast<std::size_t>(i)], i);
}

TEST(OutsideThread, WhoeverTakesNothingHoldsNobodyUp) {
  const auto gate = std::make_shared<std::promise<void>>();
  const auto opened = std::make_shared<std::shared_future<void>>(gate->get_future());
  {
    OutsideThread outside;
    ASSERT_TRUE(outside.hand([opened] { opened->wait(); }));
    std::size_t handed = 0;
    while (handed < 10 * OutsideThread::most_waiting && outside.hand([] {})) ++handed;
    EXPECT_GE(handed, OutsideThread::most_waiting - 1) << "the first one may not have been taken yet";
    EXPECT_LE(handed, OutsideThread::most_waiting);
    EXPECT_FALSE(outside.waitUntilTaken(std::chrono::milliseconds(10)));
  }  // ends although the first is stuck
  gate->set_value();
}

TEST(OutsideThread, SignalsAreForOthers) {
  OutsideThread outside;
  std::promise<bool> blocked;
  outside.hand([&blocked] {
    sigset_t mask{};
    pthread_sigmask(SIG_BLOCK, nullptr, &mask);
    blocked.set_value(sigismember(&mask, SIGTERM) == 1);
  });
  EXPECT_TRUE(blocked.get_future().get());
}

}  // namespace
}  // namespace edgeslam
