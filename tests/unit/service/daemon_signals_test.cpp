#include "service/daemon_signals.h"

#include <gtest/gtest.h>
#include <pthread.h>

namespace edgeslam {
namespace {

void raiseHere(int number) { ASSERT_EQ(pthread_kill(pthread_self(), number), 0); }

TEST(DaemonSignals, AHangUpIsAWishForTheMap) {
  DaemonSignals signals;
  EXPECT_FALSE(signals.takeMapWish());
  raiseHere(SIGHUP);
  EXPECT_FALSE(signals.end());
  EXPECT_TRUE(signals.takeMapWish());
  EXPECT_FALSE(signals.takeMapWish()) << "once";
}

TEST(DaemonSignals, OthersEndItForGood) {
  for (const int number : {SIGTERM, SIGINT}) {
    DaemonSignals signals;
    EXPECT_FALSE(signals.end());
    raiseHere(number);
    EXPECT_TRUE(signals.end());
    EXPECT_TRUE(signals.end());
    EXPECT_FALSE(signals.takeMapWish());
  }
}

TEST(BlockedSignals, AreAllowedAgainAfterwards) {
  sigset_t before{}, after{};
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  { const BlockedSignals signals; }
  pthread_sigmask(SIG_SETMASK, nullptr, &after);
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EQ(sigismember(&after, number), sigismember(&before, number));
}

}  // namespace
}  // namespace edgeslam
