// The middle of several values.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace edgeslam {

// One of the values: of an even number of them the larger of the two in the middle. Not for none.
template <typename Value>
Value median(std::vector<Value> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Likewise; of none, `fallback`.
template <typename Value>
Value medianOr(Value fallback, std::vector<Value> values) {
  return values.empty() ? fallback : median(std::move(values));
}

}  // namespace edgeslam
