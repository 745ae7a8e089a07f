#include "pipeline/channel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "pipeline/frame_slots.h"
#include "pipeline/triple_buffer.h"

namespace edgeslam {
namespace {

TEST(Channel, HoldsSoManyAndNoMore) {
  Channel<int> channel(3);
  for (int i = 0; i < 3; ++i) {
    int* slot = channel.claim();
    ASSERT_NE(slot, nullptr);
    *slot = i;
    channel.send(slot);
  }
  EXPECT_EQ(channel.claim(), nullptr);
  EXPECT_EQ(channel.room(), 0U);
  EXPECT_EQ(channel.waiting(), 3U);
  for (int i = 0; i < 3; ++i) {
    int* slot = channel.receive();
    ASSERT_NE(slot, nullptr);
    EXPECT_EQ(*slot, i);
    channel.release(slot);
  }
  EXPECT_EQ(channel.receive(), nullptr);
  EXPECT_EQ(channel.room(), 3U);
}

TEST(Channel, NothingIsLostOrTurnedRoundBetweenTwoThreads) {
  constexpr int count = 100000;
  Channel<int> channel(7);
  std::thread sender([&] {
    for (int i = 0; i < count;) {
      if (int* slot = channel.claim()) {
        *slot = i++;
        channel.send(slot);
      } else {
        std::this_thread::yield();
      }
    }
  });
  int next = 0;
  while (next < count) {
    int* slot = channel.receive();
    if (!slot) {
      std::this_thread::yield();
      continue;
    }
    EXPECT_EQ(*slot, next);
    ++next;
    channel.release(slot);
  }
  sender.join();
}

TEST(TripleBuffer, TheReaderGetsTheNewestValueOnce) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.take());
  buffer.writing() = 1;
  EXPECT_FALSE(buffer.publish());
  buffer.writing() = 2;
  EXPECT_TRUE(buffer.publish()) << "1 was never read";
  ASSERT_TRUE(buffer.take());
  EXPECT_EQ(buffer.reading(), 2);
  EXPECT_FALSE(buffer.take());
  EXPECT_EQ(buffer.reading(), 2) << "stays the reader's";
}

TEST(TripleBuffer, ValuesAreWholeAndNeverGoBack) {
  struct Pair {
    std::int64_t a = 0, b = 0;
  };
  constexpr std::int64_t count = 200000;
  TripleBuffer<Pair> buffer;
  std::thread writer([&] {
    for (std::int64_t i = 1; i <= count; ++i) {
      buffer.writing() = {i, -i};
      buffer.publish();
    }
  });
  std::int64_t last = 0;
  while (last < count) {
    if (!buffer.take()) continue;
    EXPECT_EQ(buffer.reading().a, -buffer.reading().b);
    EXPECT_GT(buffer.reading().a, last);
    last = buffer.reading().a;
  }
  writer.join();
}

TEST(FrameSlots, TheNewestFrameWinsAndTheOthersAreTold) {
  FrameSlots slots(8, 6);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(slots.writing().grey.size(), cv::Size(8, 6));
    slots.writing().index = i;
    slots.publish();
  }
  ASSERT_TRUE(slots.take());
  EXPECT_EQ(slots.reading().index, 3);
  PassedOverFrame passed_over;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(slots.nextPassedOver(passed_over));
    EXPECT_EQ(passed_over.index, i);
  }
  EXPECT_FALSE(slots.nextPassedOver(passed_over));
}

}  // namespace
}  // namespace edgeslam
