// The latest samples of a sensor in the order of time, in memory that is taken once. Of each a function timeOf() tells
// its time, in one unit for all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgeslam {

template <typename Sample>
class SampleRing {
 public:
  // Takes all its memory at once.
  explicit SampleRing(std::size_t most) : samples_(most) {}

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  // The oldest is at 0.
  const Sample& at(std::size_t place) const { return samples_[(first_ + place) % samples_.size()]; }
  const Sample& last() const { return at(count_ - 1); }

  // Whether what comes now, of this time, is the next one: it is after the last. Where many in a row are older, the
  // clock was set back: all that was before is forgotten, and it is the first of what follows.
  bool isNext(std::int64_t time) {
    constexpr int older_for_a_new_clock = 20;
    if (count_ > 0 && time <= timeOf(last())) {
      if (time < timeOf(last())) ++older_in_a_row_;
      if (older_in_a_row_ < older_for_a_new_clock) return false;
      count_ = 0;
    }
    older_in_a_row_ = 0;
    return true;
  }

  // One that isNext(); the oldest makes room for it.
  void push(const Sample& sample) {
    if (count_ == samples_.size()) popFirst();
    samples_[(first_ + count_++) % samples_.size()] = sample;
  }
  void popFirst() {
    first_ = (first_ + 1) % samples_.size();
    --count_;
  }

  // Place of the first one whose time is after this; size() where there is none.
  std::size_t firstAfter(std::int64_t time) const {
    std::size_t begin = 0, end = count_;
    while (begin < end) {
      const std::size_t middle = begin + (end - begin) / 2;
      if (timeOf(at(middle)) > time) {
        end = middle;
      } else {
        begin = middle + 1;
      }
    }
    return begin;
  }

 private:
  std::vector<Sample> samples_;
  std::size_t first_ = 0, count_ = 0;
  int older_in_a_row_ = 0;
};

}  // namespace edgeslam
