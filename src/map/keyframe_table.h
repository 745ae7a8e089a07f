// Entries by keyframe number, ascending. Numbers have gaps: keyframes that add nothing are culled.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "map/keyframe.h"

namespace edgeslam {

// `Entry` has a field `KeyframeId id`.
template <typename Entry>
class KeyframeTable {
 public:
  KeyframeTable() = default;
  KeyframeTable(std::initializer_list<Entry> entries) {
    for (const Entry& entry : entries) push_back(entry);
  }

  // The entry, or null.
  const Entry* find(KeyframeId id) const {
    const std::size_t place = placeOf(id);
    return place < entries_.size() && entries_[place].id == id ? &entries_[place] : nullptr;
  }
  Entry* find(KeyframeId id) { return const_cast<Entry*>(std::as_const(*this).find(id)); }
  bool contains(KeyframeId id) const { return find(id) != nullptr; }

  // The entry, which must be there.
  const Entry& operator[](KeyframeId id) const {
    const Entry* entry = find(id);
    if (!entry) throw std::out_of_range("no keyframe " + std::to_string(id));
    return *entry;
  }
  Entry& operator[](KeyframeId id) { return const_cast<Entry&>(std::as_const(*this)[id]); }

  // Its number must be over all others'.
  void push_back(Entry entry) {
    if (!entries_.empty() && entry.id <= entries_.back().id) {
      throw std::logic_error("keyframe " + std::to_string(entry.id) + " after " + std::to_string(entries_.back().id));
    }
    entries_.push_back(std::move(entry));
  }
  void erase(KeyframeId id) {
    if (contains(id)) entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(placeOf(id)));
  }
  void clear() { entries_.clear(); }
  void reserve(std::size_t count) { entries_.reserve(count); }

  // In the order of the numbers.
  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }
  const Entry& front() const { return entries_.front(); }
  const Entry& back() const { return entries_.back(); }
  Entry& back() { return entries_.back(); }
  const Entry& atPlace(std::size_t place) const { return entries_[place]; }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  auto begin() { return entries_.begin(); }
  auto end() { return entries_.end(); }

  // The first place whose number is not below `id`; without gaps it is the number less the first one.
  std::size_t placeOf(KeyframeId id) const {
    if (entries_.empty() || id <= entries_.front().id) return 0;
    const auto place = static_cast<std::size_t>(id - entries_.front().id);
    if (place < entries_.size() && entries_[place].id == id) return place;
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), id,
                                        [](const Entry& entry, KeyframeId wanted) { return entry.id < wanted; });
    return static_cast<std::size_t>(found - entries_.begin());
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace edgeslam
