// A bounded queue between two threads whose entries live in slots that are made once and used again, so that what an
// entry holds keeps its memory. Wait-free on both sides (Boost.Lockfree's single-producer single-consumer queue).
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <vector>

namespace edgeslam {

template <typename Entry>
class Channel {
 public:
  explicit Channel(std::size_t capacity) : slots_(capacity), free_(capacity), sent_(capacity) {
    for (Entry& slot : slots_) free_.push(&slot);
  }
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  // Before the first entry: gives the slots their memory.
  template <typename Prepare>
  void forEachSlot(const Prepare& prepare) {
    for (Entry& slot : slots_) prepare(slot);
  }

  // The sender's side: a slot to fill, as it was when it was last used; null where the queue is full. Claim again only
  // after it was sent.
  Entry* claim() {
    Entry* slot = nullptr;
    free_.pop(slot);
    return slot;
  }
  void send(Entry* slot) { sent_.push(slot); }
  // Slots that can still be claimed.
  std::size_t room() const { return free_.read_available(); }

  // The receiver's side: the oldest entry, null where there is none; it is the receiver's until it is released.
  Entry* receive() {
    Entry* slot = nullptr;
    sent_.pop(slot);
    return slot;
  }
  void release(Entry* slot) { free_.push(slot); }
  std::size_t waiting() const { return sent_.read_available(); }

 private:
  std::vector<Entry> slots_;
  boost::lockfree::spsc_queue<Entry*> free_;  // from the receiver to the sender
  boost::lockfree::spsc_queue<Entry*> sent_;  // from the sender to the receiver
};

}  // namespace edgeslam
