// Large values that are shared for a while and then used again, with the memory that they hold: the images of frames.
// Taking one and letting the last share of one go is lock-free and without allocation, in any thread.
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/stack.hpp>
#include <cstddef>
#include <functional>
#include <memory>

namespace edgeslam {

template <typename Value>
class RecyclingPool {
 public:
  // `prepare` gives a new value its memory. Values may outlive the pool.
  explicit RecyclingPool(std::function<void(Value&)> prepare)
      : store_(std::make_shared<Store>()), prepare_(std::move(prepare)) {}

  // An unused value, as it was left; where none is ready, a new one, which is an allocation.
  std::shared_ptr<Value> take() {
    Slot* slot = nullptr;
    if (!store_->unused.pop(slot)) return share(makeSlot());
    store_->ready.fetch_sub(1, std::memory_order_relaxed);
    return share(slot);
  }

  // Makes values until so many are ready, about; for a thread that has the time.
  void keepReady(int count) {
    while (store_->ready.load(std::memory_order_relaxed) < count) store_->giveBack(makeSlot().release());
  }

  // Gives the memory of unused values up, but for so many, about; likewise.
  void dropUnused(int most) {
    Slot* slot = nullptr;
    while (store_->ready.load(std::memory_order_relaxed) > most && store_->unused.pop(slot)) {
      store_->ready.fetch_sub(1, std::memory_order_relaxed);
      delete slot;
    }
  }

 private:
  static constexpr std::size_t most_unused = 1024;
  static constexpr std::size_t control_size = 128;  // of a shared pointer's count, [bytes]

  struct Slot {
    Value value;
    alignas(std::max_align_t) std::array<std::byte, control_size> control;
  };

  struct Store {
    boost::lockfree::stack<Slot*, boost::lockfree::capacity<most_unused>> unused;
    std::atomic<int> ready{0};

    ~Store() {
      unused.consume_all([](Slot* slot) { delete slot; });
    }
    void giveBack(Slot* slot) noexcept {
      ready.fetch_add(1, std::memory_order_relaxed);
      if (unused.bounded_push(slot)) return;
      ready.fetch_sub(1, std::memory_order_relaxed);
      delete slot;
    }
  };

  // The shared pointer's count lies in the slot as well; when it is let go, so is the slot.
  template <typename Control>
  struct ControlAllocator {
    using value_type = Control;
    Slot* slot;
    std::shared_ptr<Store> store;

    ControlAllocator(Slot* its_slot, std::shared_ptr<Store> its_store) : slot(its_slot), store(std::move(its_store)) {}
    template <typename Other>
    ControlAllocator(const ControlAllocator<Other>& other) : slot(other.slot), store(other.store) {}
    Control* allocate(std::size_t) noexcept {
      static_assert(sizeof(Control) <= control_size);
      return reinterpret_cast<Control*>(slot->control.data());
    }
    void deallocate(Control*, std::size_t) noexcept { store->giveBack(slot); }
    template <typename Other>
    bool operator==(const ControlAllocator<Other>& other) const {
      return slot == other.slot;
    }
  };

  struct KeepValue {
    void operator()(Value*) const noexcept {}
  };

  std::unique_ptr<Slot> makeSlot() const {
    auto slot = std::make_unique<Slot>();
    prepare_(slot->value);
    return slot;
  }
  std::shared_ptr<Value> share(std::unique_ptr<Slot> slot) { return share(slot.release()); }
  std::shared_ptr<Value> share(Slot* slot) {
    return std::shared_ptr<Value>(&slot->value, KeepValue(), ControlAllocator<Value>(slot, store_));
  }

  std::shared_ptr<Store> store_;
  std::function<void(Value&)> prepare_;
};

}  // namespace edgeslam
