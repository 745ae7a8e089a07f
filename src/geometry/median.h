// The median of some values, where it shall be one of the values and not a mean of two.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <type_traits>

namespace edgeslam {

// The value at place size / 2 (counted from 0) of the sorted values: the middle one of an odd number, the upper of the
// two middle ones of an even number. Values, such as a std::vector or std::pmr::vector, are reordered where they are;
// nothing is copied. There must be at least one, and no NaN.
template <typename Values>
typename std::decay_t<Values>::value_type upperMedian(Values&& values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The same of a copy, and `fallback` where there are no values.
template <typename Values>
typename Values::value_type medianOr(typename Values::value_type fallback, Values values) {
  return values.empty() ? fallback : upperMedian(values);
}

}  // namespace edgeslam
