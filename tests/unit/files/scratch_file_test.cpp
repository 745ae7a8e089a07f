// A file without a name: what was put in comes out, also once it is full.
#include "files/scratch_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

namespace edgeslam {
namespace {

constexpr std::size_t some = 12;  // bytes
using Bytes = std::array<char, some>;

Bytes filledWith(char byte) {
  Bytes bytes{};
  bytes.fill(byte);
  return bytes;
}

TEST(ScratchFile, GivesBackWhatItTook) {
  ScratchFile file(1000);
  const Bytes first = filledWith('a'), second = filledWith('b');
  ASSERT_TRUE(file.append(first.data(), some)) << file.problem();
  Bytes read{};
  ASSERT_TRUE(file.read(0, read.data(), some));
  EXPECT_EQ(read, first);
  ASSERT_TRUE(file.append(second.data(), some)) << "after it was read from";
  ASSERT_TRUE(file.read(some, read.data(), some));
  EXPECT_EQ(read, second);
  EXPECT_EQ(file.size(), 2 * some);
}

TEST(ScratchFile, WhatWasNeverAppendedIsNotThere) {
  ScratchFile file(1000);
  Bytes bytes = filledWith('a');
  ASSERT_TRUE(file.append(bytes.data(), some));
  EXPECT_FALSE(file.read(1, bytes.data(), some));
  EXPECT_FALSE(file.read(1000, bytes.data(), 1));
}

TEST(ScratchFile, AFullOneSaysSoAndKeepsWhatItHas) {
  ScratchFile file(some + 5);
  Bytes bytes = filledWith('a');
  ASSERT_TRUE(file.append(bytes.data(), some));
  EXPECT_FALSE(file.append(bytes.data(), some));
  EXPECT_FALSE(file.problem().empty());
  EXPECT_FALSE(file.append(bytes.data(), 1)) << "nothing more is taken, so that nothing is missing in between";
  EXPECT_TRUE(file.read(0, bytes.data(), some));
}

}  // namespace
}  // namespace edgeslam
