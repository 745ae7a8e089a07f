#include "tracking/recycling_pool.h"

#include <gtest/gtest.h>

#include <vector>

namespace edgeslam {
namespace {

struct Counted {
  std::shared_ptr<int> alive;
};

// A pool whose values' number is that of the shares of `alive`, less its own two.
class RecyclingPoolTest : public testing::Test {
 protected:
  std::shared_ptr<int> alive_ = std::make_shared<int>();
  RecyclingPool<Counted> pool_{[alive = alive_](Counted& value) { value.alive = alive; }};

  long values() const { return alive_.use_count() - 2; }
  void takeAndLetGo(std::size_t count) {
    std::vector<std::shared_ptr<Counted>> taken(count);
    for (std::shared_ptr<Counted>& value : taken) value = pool_.take();
  }
};

TEST_F(RecyclingPoolTest, UsesAgainWhatWasLetGo) {
  const Counted* place = pool_.take().get();
  EXPECT_EQ(pool_.take().get(), place);
  EXPECT_EQ(values(), 1);
}

TEST_F(RecyclingPoolTest, KeepsSoManyReady) {
  pool_.keepReady(3);
  EXPECT_EQ(values(), 3);
  takeAndLetGo(5);
  pool_.keepReady(3);
  EXPECT_EQ(values(), 5);
}

TEST_F(RecyclingPoolTest, GivesUpWhatIsNotUsed) {
  takeAndLetGo(9);
  const std::shared_ptr<Counted> used = pool_.take();
  pool_.dropUnused(2);
  EXPECT_EQ(values(), 3);
  pool_.dropUnused(0);
  EXPECT_EQ(values(), 1);
  EXPECT_TRUE(used->alive);
  takeAndLetGo(1);
  EXPECT_EQ(values(), 2);
}

}  // namespace
}  // namespace edgeslam
