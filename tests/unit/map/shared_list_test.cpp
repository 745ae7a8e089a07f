#include "map/shared_list.h"

#include <gtest/gtest.h>

#include <vector>

namespace edgeslam {
namespace {

std::vector<int> valuesOf(const SharedList<int>& list) { return {list.begin(), list.end()}; }

TEST(SharedList, CopiesShareTheirMemory) {
  const SharedList<int> list(std::vector<int>{1, 2, 3});
  const SharedList<int> copy = list;
  EXPECT_EQ(copy.begin(), list.begin());
}

TEST(SharedList, AChangeIsOfOneCopyAlone) {
  SharedList<int> list(std::vector<int>{1, 2, 4});
  SharedList<int> copy = list;
  copy.insert(copy.begin() + 2, 3);
  EXPECT_EQ(valuesOf(copy), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(valuesOf(list), (std::vector<int>{1, 2, 4}));
  list.clear();
  EXPECT_EQ(valuesOf(copy), (std::vector<int>{1, 2, 3, 4}));
}

TEST(SharedList, AnEmptyOneCanBeRead) {
  SharedList<int> list;
  EXPECT_TRUE(list.empty());
  EXPECT_EQ(list.size(), 0U);
  EXPECT_EQ(list.capacity(), 0U);
  EXPECT_EQ(list.begin(), list.end());
  EXPECT_TRUE(SharedList<int>(std::vector<int>()).empty());
  list.push_back(5);
  list.push_back(7);
  EXPECT_EQ(list.front(), 5);
  EXPECT_EQ(list.back(), 7);
  EXPECT_EQ(list[1], 7);
}

}  // namespace
}  // namespace edgeslam
