// A list whose copies share its memory; what changes one copies it first. For what is rarely changed and often copied,
// as a keyframe's observations with each copy of the map.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace edgeslam {

template <typename Value>
class SharedList {
 public:
  using value_type = Value;

  SharedList() = default;
  SharedList(std::vector<Value> values) {
    if (!values.empty()) values_ = std::make_shared<const std::vector<Value>>(std::move(values));
  }

  bool empty() const { return !values_; }
  std::size_t size() const { return values_ ? values_->size() : 0; }
  std::size_t capacity() const { return values_ ? values_->capacity() : 0; }
  const Value* begin() const { return values_ ? values_->data() : nullptr; }
  const Value* end() const { return begin() + size(); }
  const Value& front() const { return values_->front(); }
  const Value& back() const { return values_->back(); }
  const Value& operator[](std::size_t index) const { return (*values_)[index]; }

  // Changes this copy alone.
  void insert(const Value* place, const Value& value) {
    std::vector<Value> values(begin(), end());
    values.insert(values.begin() + (place - begin()), value);
    *this = SharedList(std::move(values));
  }
  void push_back(const Value& value) { insert(end(), value); }
  void clear() { values_.reset(); }

 private:
  std::shared_ptr<const std::vector<Value>> values_;  // null: none
};

}  // namespace edgeslam
