// Entries by keyframe number, where numbers have gaps.
#include "map/keyframe_table.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace edgeslam {
namespace {

struct Numbered {
  KeyframeId id = 0;
};

std::vector<KeyframeId> numbersOf(const KeyframeTable<Numbered>& table) {
  std::vector<KeyframeId> numbers;
  for (const Numbered& entry : table) numbers.push_back(entry.id);
  return numbers;
}

TEST(KeyframeTable, HoldsWhatASetHolds) {
  std::mt19937 random(3);
  KeyframeTable<Numbered> table;
  std::set<KeyframeId> expected;
  for (KeyframeId id = 0; id < 400; ++id) {
    if (random() % 4 > 0) {
      table.push_back({id});
      expected.insert(id);
    }
    if (random() % 3 == 0) {
      const auto culled = static_cast<KeyframeId>(random() % static_cast<unsigned>(id + 1));
      table.erase(culled);
      expected.erase(culled);
    }
  }
  ASSERT_EQ(numbersOf(table), std::vector<KeyframeId>(expected.begin(), expected.end()));
  for (KeyframeId id = -2; id < 403; ++id) {
    ASSERT_EQ(table.contains(id), expected.count(id) > 0) << id;
    const auto place = static_cast<std::size_t>(std::distance(expected.begin(), expected.lower_bound(id)));
    EXPECT_EQ(table.placeOf(id), place) << id;
    if (!table.contains(id)) continue;
    EXPECT_EQ(table[id].id, id);
    EXPECT_EQ(table.atPlace(table.placeOf(id)).id, id);
  }
}

TEST(KeyframeTable, RefusesWhatIsNotThereOrOutOfOrder) {
  KeyframeTable<Numbered> table{{2}, {5}};
  EXPECT_THROW(table[3], std::out_of_range);
  EXPECT_THROW(table.push_back({5}), std::logic_error);
  EXPECT_THROW(table.push_back({4}), std::logic_error);
  table.erase(3);
  EXPECT_EQ(numbersOf(table), (std::vector<KeyframeId>{2, 5}));
}

}  // namespace
}  // namespace edgeslam
