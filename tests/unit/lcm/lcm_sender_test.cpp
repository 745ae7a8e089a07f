// A full pipe stands in for a link that is slower than what is sent.
#include "drivers/lcm/lcm_sender.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "edgeslam/state_t.hpp"
#include "unit/files/temporary_folder.h"
#include "unit/lcm/comes_true.h"

namespace edgeslam {
namespace {

TEST(LcmSender, ALinkThatBlocksBlocksNobody) {
  const TemporaryFolder folder;
  const std::string path = folder.path("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  {
    LcmSender sender("file://" + path + "?mode=w");
    const state_t state{};
    const int count = 3000;  // more than the pipe and the queue hold
    for (int i = 0; i < count; ++i) sender.send("SLAM_STATE", state);
    EXPECT_GT(sender.notSent(), 0) << "returned all the same, and counted";
    EXPECT_NE(sender.problem().find("more slowly than they come"), std::string::npos) << sender.problem();

    std::vector<char> buffer(1 << 16);
    EXPECT_TRUE(comesTrue([&] {
      while (read(reader, buffer.data(), buffer.size()) > 0) continue;
      return sender.sent() + sender.notSent() == count && sender.problem().empty();
    })) << "goes on when the link does; none is counted twice";
    EXPECT_GT(sender.sent(), 0);
  }
  close(reader);
}

TEST(LcmSender, WhatHasWaitedTooLongIsLeftOut) {
  const TemporaryFolder folder;
  const std::string path = folder.path("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  {
    LcmSender sender("file://" + path + "?mode=w");
    const int count = 500;  // more than the pipe holds, less than the queue does
    for (int i = 0; i < count; ++i) sender.send("SLAM_STATE", state_t{});
    EXPECT_EQ(sender.notSent(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    std::vector<char> buffer(1 << 16);
    EXPECT_TRUE(comesTrue([&] {
      while (read(reader, buffer.data(), buffer.size()) > 0) continue;
      return sender.sent() + sender.notSent() == count;
    }));
    EXPECT_GT(sender.notSent(), 200);
    sender.send("SLAM_STATE", state_t{});
    EXPECT_TRUE(comesTrue([&] {
      while (read(reader, buffer.data(), buffer.size()) > 0) continue;
      return sender.sent() + sender.notSent() == count + 1 && sender.problem().empty();
    })) << "what is new goes out";
  }
  close(reader);
}

TEST(LcmSender, WhatWaitsGoesOutAtTheEnd) {
  const TemporaryFolder folder;
  const std::string path = folder.path("log");
  {
    LcmSender sender("file://" + path + "?mode=w");
    for (int i = 0; i < 100; ++i) sender.send("SLAM_STATE", state_t{});
  }
  EXPECT_EQ(fileContent(path).size() % 100, 0U);
  EXPECT_GT(fileContent(path).size(), 100U * static_cast<std::size_t>(state_t().getEncodedSize()));
}

TEST(BackOff, WaitsTwiceAsLongEachTimeUpToFiveSeconds) {
  using std::chrono::milliseconds;
  BackOff back_off;
  BackOff::Clock::time_point now(std::chrono::hours(1));
  EXPECT_TRUE(back_off.due(now));
  for (const int wait_ms : {100, 200, 400, 800, 1600, 3200, 5000, 5000}) {
    back_off.failed(now);
    EXPECT_FALSE(back_off.due(now + milliseconds(wait_ms - 1))) << wait_ms;
    now += milliseconds(wait_ms);
    EXPECT_TRUE(back_off.due(now)) << wait_ms;
  }
  back_off.failed(now);
  back_off.reset();
  EXPECT_TRUE(back_off.due(now));
}

}  // namespace
}  // namespace edgeslam
