#include "soak/soak_minutes.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

// Twelve passes over two sequences, nothing grows.
std::vector<SoakMinute> flat() {
  std::vector<SoakMinute> minutes;
  for (int pass = 0; pass < 12; ++pass) {
    for (const char* sequence : {"hall", "room"}) {
      SoakMinute minute;
      minute.pass = pass;
      minute.sequence = sequence;
      minute.memory_mb = pass == 0 ? 60 : 100 + pass % 3;
      minute.processor_ms = 9 + pass % 2;
      minute.latency_50_ms = 5;
      minutes.push_back(minute);
    }
  }
  return minutes;
}

TEST(SoakMinutes, WhatStaysAsItIsIsNoProblem) { EXPECT_TRUE(soakProblems(flat()).empty()); }

TEST(SoakMinutes, TwoPassesAreTooFew) {
  std::vector<SoakMinute> minutes = flat();
  minutes.resize(4);
  EXPECT_EQ(soakProblems(minutes).size(), 1U);
  EXPECT_EQ(soakProblems({}).size(), 1U);
}

TEST(SoakMinutes, ALeakIsSeen) {
  std::vector<SoakMinute> minutes = flat();
  for (SoakMinute& minute : minutes) minute.memory_mb += 5 * static_cast<double>(minute.pass);
  ASSERT_EQ(soakProblems(minutes).size(), 1U);
  EXPECT_EQ(soakProblems(minutes)[0].rfind("memory", 0), 0U);
}

TEST(SoakMinutes, WhatGetsSlowerIsSeenInItsSequence) {
  std::vector<SoakMinute> minutes = flat();
  for (SoakMinute& minute : minutes) {
    if (minute.sequence == "hall") minute.processor_ms += static_cast<double>(minute.pass);
    if (minute.sequence == "room") minute.latency_50_ms += 2 * static_cast<double>(minute.pass);
  }
  const std::vector<std::string> problems = soakProblems(minutes);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].rfind("hall: processor", 0), 0U) << problems[0];
  EXPECT_EQ(problems[1].rfind("room: median latency", 0), 0U) << problems[1];
}

// One pass that costs more is no growth.
TEST(SoakMinutes, AScatterIsNotGrowth) {
  std::vector<SoakMinute> minutes = flat();
  for (SoakMinute& minute : minutes) {
    if (minute.pass == 11 || minute.pass == 3) minute.processor_ms *= 1.9;
  }
  EXPECT_TRUE(soakProblems(minutes).empty());
}

}  // namespace
}  // namespace edgeslam
