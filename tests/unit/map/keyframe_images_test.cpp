#include "map/keyframe_images.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <thread>
#include <vector>

#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

bool areSame(const FrameImages& a, const FrameImages& b) {
  if (a.frame_index != b.frame_index || a.time_ns != b.time_ns) return false;
  if (a.pyramid.levels.size() != b.pyramid.levels.size()) return false;
  for (std::size_t level = 0; level < a.pyramid.levels.size(); ++level) {
    cv::Mat one = a.pyramid.levels[level], other = b.pyramid.levels[level];
    for (cv::Mat* with_border : {&one, &other}) {
      with_border->adjustROI(pyramid_border, pyramid_border, pyramid_border, pyramid_border);
    }
    if (one.size() != other.size() || cv::norm(one, other, cv::NORM_INF) != 0) return false;
  }
  return true;
}

TEST(KeyframeImages, AreTheSameAfterTheyWerePacked) {
  for (const int levels : {1, 3, 6}) {
    auto made = test::madeImages(333, 241, levels, 7);
    const std::weak_ptr<const FrameImages> first = made;
    const KeyframeImages images = std::move(made);
    ASSERT_TRUE(images);
    ASSERT_TRUE(images.pack());
    EXPECT_TRUE(first.expired());
    EXPECT_TRUE(images);
    for (int turn = 0; turn < 3; ++turn) {
      EXPECT_TRUE(areSame(*images.get(), *test::madeImages(333, 241, levels, 7)));
      EXPECT_TRUE(images.pack());
    }
  }
}

TEST(KeyframeImages, StayForAsLongAsTheyAreHeld) {
  KeyframeImages images = test::madeImages(64, 48, 2, 1);
  std::shared_ptr<const FrameImages> held = images.get();
  const FrameImages* place = held.get();
  EXPECT_FALSE(images.pack());
  EXPECT_EQ(images.get().get(), place);
  held.reset();
  EXPECT_TRUE(images.pack());
  EXPECT_FALSE(images.pack());  // they are packed
}

TEST(KeyframeImages, CopiesShareThem) {
  const KeyframeImages images = test::madeImages(64, 48, 2, 1);
  const KeyframeImages copy = images;
  EXPECT_EQ(copy.get(), images.get());
  EXPECT_TRUE(copy.pack());
  EXPECT_EQ(copy.get(), images.get());
}

TEST(KeyframeImages, AreAsLargeAsTheirLevels) {
  const KeyframeImages images = test::madeImages(64, 48, 2, 1);
  EXPECT_EQ(images.size(), 64U * 48 + 32U * 24);
  images.pack();
  EXPECT_EQ(images.size(), 64U * 48 + 32U * 24);
}

TEST(KeyframeImages, MayBeNone) {
  KeyframeImages images;
  EXPECT_FALSE(images);
  EXPECT_EQ(images.get(), nullptr);
  EXPECT_FALSE(images.pack());
  EXPECT_EQ(images.size(), 0U);
  images = test::madeImages(64, 48, 2, 1);
  EXPECT_TRUE(images);
  images = nullptr;
  EXPECT_FALSE(images);
}

TEST(KeyframeImages, AreGivenToSeveralThreadsWhileTheyArePacked) {
  const KeyframeImages images = test::madeImages(96, 64, 3, 2);
  const auto expected = test::madeImages(96, 64, 3, 2);
  std::vector<char> all_same(3, 1);
  std::vector<std::thread> threads;
  for (char& same : all_same) {
    threads.emplace_back([&same, images, &expected] {
      for (int turn = 0; turn < 200; ++turn) {
        const std::shared_ptr<const FrameImages> held = images.get();
        same = same != 0 && areSame(*held, *expected) ? 1 : 0;
        images.pack();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const char same : all_same) EXPECT_EQ(same, 1);
}

}  // namespace
}  // namespace edgeslam
