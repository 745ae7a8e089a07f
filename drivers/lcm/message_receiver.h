// Messages of one channel as they come in, checked one by one, for a thread that takes them when it has time.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "drivers/lcm/lcm_listener.h"

namespace edgeslam {

// Up to `most` of them wait.
template <typename Value, std::size_t most>
class MessageReceiver {
 public:
  // What a message says; none where it says nothing of use.
  using Check = std::optional<Value> (*)(const void* data, std::size_t bytes);

  // `url` from effectiveUrl(), one that canReceive(). `thread_name`: at most 15 letters.
  MessageReceiver(std::string url, std::string channel, const char* thread_name, Check check)
      : check_(check),
        listener_(std::move(url), std::move(channel), thread_name,
                  [this](const void* data, std::size_t bytes) { take(data, bytes); }) {}

  // The oldest that waits, or none. One thread's alone.
  std::optional<Value> next() {
    Value value;
    if (!waiting_.pop(value)) return std::nullopt;
    return value;
  }

  // Messages that said nothing of use, and those for which the queue was full.
  std::int64_t ignored() const { return ignored_.load(std::memory_order_relaxed); }
  LcmListener& listener() { return listener_; }

 private:
  void take(const void* data, std::size_t bytes) {
    const std::optional<Value> value = check_(data, bytes);
    if (!value || !waiting_.push(*value)) ignored_.fetch_add(1, std::memory_order_relaxed);
  }

  Check check_;
  boost::lockfree::spsc_queue<Value, boost::lockfree::capacity<most>> waiting_;
  std::atomic<std::int64_t> ignored_{0};
  LcmListener listener_;  // last: its thread uses the others
};

}  // namespace edgeslam
