#include "service/event_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <thread>
#include <vector>

namespace edgeslam {
namespace {

using std::chrono::seconds;

std::int64_t linesOf(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(EventLog, ALineAnEvent) {
  std::ostringstream stream;
  EventLog log(stream);
  log.tell("one\nand\rmore");
  ASSERT_TRUE(log.waitUntilOut());
  EXPECT_EQ(stream.str(), "edgeslam: one and more\n");
}

TEST(EventLog, AFloodIsCutAndCounted) {
  std::ostringstream stream;
  EventLog log(stream);
  const auto start = EventLog::Clock::now();
  for (int i = 0; i < 500; ++i) log.tell("noise", start + std::chrono::milliseconds(i));
  ASSERT_TRUE(log.waitUntilOut());
  EXPECT_EQ(linesOf(stream.str()), EventLog::most_lines);
  log.tell("calm", start + seconds(EventLog::window_s));
  ASSERT_TRUE(log.waitUntilOut());
  EXPECT_NE(stream.str().find("edgeslam: 480 lines were left out\nedgeslam: calm\n"), std::string::npos)
      << stream.str();
}

TEST(EventLog, LinesOfManyThreadsAreWhole) {
  std::ostringstream stream;
  EventLog log(stream);
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&log] {
      for (int k = 0; k < 4; ++k) log.tell("0123456789");
    });
  }
  for (std::thread& thread : threads) thread.join();
  ASSERT_TRUE(log.waitUntilOut());
  std::string expected;
  for (int i = 0; i < 16; ++i) expected += "edgeslam: 0123456789\n";
  EXPECT_EQ(stream.str(), expected);
}

}  // namespace
}  // namespace edgeslam
