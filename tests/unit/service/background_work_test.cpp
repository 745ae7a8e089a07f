#include "service/background_work.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "unit/lcm/comes_true.h"

namespace edgeslam {
namespace {

TEST(BackgroundWork, IsDoneInOrderAndCompletedByTheCaller) {
  BackgroundWork work;
  std::vector<int> completed;
  const std::thread::id caller = std::this_thread::get_id();
  for (int i = 0; i < 20; ++i) {
    work.begin([&, i]() -> BackgroundWork::Completion {
      EXPECT_NE(std::this_thread::get_id(), caller);
      return [&, i] {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        completed.push_back(i);
      };
    });
  }
  EXPECT_TRUE(completed.empty());
  work.finish();
  work.complete();
  ASSERT_EQ(completed.size(), 20U);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(completed[static_cast<std::size_t>(i)], i);
}

TEST(BackgroundWork, NobodyWaitsForItUnlessAsked) {
  std::atomic<bool> go{false}, done{false};
  {
    BackgroundWork work;
    work.begin([&]() -> BackgroundWork::Completion {
      EXPECT_TRUE(comesTrue([&] { return go.load(); }));
      done = true;
      return {};
    });
    work.complete();
    EXPECT_FALSE(done);
    go = true;
  }
  EXPECT_TRUE(done) << "what was begun is done at the end";
}

TEST(BackgroundWork, ACompletionMayBeginMore) {
  BackgroundWork work;
  int completions = 0;
  work.begin([&]() -> BackgroundWork::Completion {
    return [&] {
      ++completions;
      work.begin([&]() -> BackgroundWork::Completion { return [&] { ++completions; }; });
    };
  });
  for (int i = 0; i < 2; ++i) {
    work.finish();
    work.complete();
  }
  EXPECT_EQ(completions, 2);
}

}  // namespace
}  // namespace edgeslam
