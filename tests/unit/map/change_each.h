// Changes every value of a list whose copies share their memory.
#pragma once

#include <vector>

#include "map/shared_list.h"

namespace edgeslam::test {

// `change` gets each value in order.
template <typename Value, typename Change>
void changeEach(SharedList<Value>& list, const Change& change) {
  std::vector<Value> values(list.begin(), list.end());
  for (Value& value : values) change(value);
  list = std::move(values);
}

}  // namespace edgeslam::test
