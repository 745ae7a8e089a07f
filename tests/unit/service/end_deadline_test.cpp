#include "service/end_deadline.h"

#include <gtest/gtest.h>

#include <csignal>
#include <iostream>
#include <thread>
#include <vector>

#include "service/daemon_signals.h"

namespace edgeslam {
namespace {

using std::chrono::milliseconds;

const auto ended_by_deadline = testing::ExitedWithCode(1);
constexpr const char* deadline_told = "^edgeslam: the disk does not answer: ended all the same, [^\n]*\n$";

// For as long as a disk that never answers.
void wait() { std::this_thread::sleep_for(std::chrono::seconds(60)); }

void waitAfter(void (*ask)(EndDeadline&)) {
  DaemonSignals signals;
  EventLog log(std::cerr);
  EndDeadline deadline(log, milliseconds(200));
  ask(deadline);
  wait();
}

// By several threads, so that the processor is had for half of the time whatever else runs.
void work(milliseconds duration) {
  const auto end = std::chrono::steady_clock::now() + duration;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([end] {
      while (std::chrono::steady_clock::now() < end) continue;
    });
  }
  for (std::thread& thread : threads) thread.join();
}

class EndDeadlineDeathTest : public testing::Test {
 protected:
  EndDeadlineDeathTest() { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

TEST_F(EndDeadlineDeathTest, ADiskThatNeverAnswersHoldsTheEndNoLonger) {
  EXPECT_EXIT(waitAfter([](EndDeadline& deadline) { deadline.begin(); }), ended_by_deadline, deadline_told);
}

// The thread that would take the signal waits for the disk.
TEST_F(EndDeadlineDeathTest, NorASignalThatNobodyTakes) {
  EXPECT_EXIT(waitAfter([](EndDeadline&) { kill(getpid(), SIGTERM); }), ended_by_deadline, deadline_told);
  EXPECT_EXIT(waitAfter([](EndDeadline&) { kill(getpid(), SIGINT); }), ended_by_deadline, deadline_told);
}

TEST(EndDeadline, WithoutASignalNothingEnds) {
  const DaemonSignals signals;
  EventLog log(std::cerr);
  const EndDeadline deadline(log, milliseconds(0));
  std::this_thread::sleep_for(milliseconds(500));
}

// A large map is packed for longer than a disk is waited for.
TEST(EndDeadline, WorkIsNotWaiting) {
  EventLog log(std::cerr);
  EndDeadline deadline(log, milliseconds(3000));
  deadline.begin();
  work(milliseconds(3600));
}

}  // namespace
}  // namespace edgeslam
