// What goes out of the program to someone who may not take it at once: the journal's pipe, the service manager's
// socket.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

namespace edgeslam {

// Hands it on in order, in a thread of its own. For all threads.
class OutsideThread {
 public:
  static constexpr std::size_t most_waiting = 64;
  static constexpr auto patience = std::chrono::seconds(1);

  OutsideThread();
  // Waits for `patience`; what is not taken by then is given up, with the thread that is stuck in it.
  ~OutsideThread();
  OutsideThread(const OutsideThread&) = delete;
  OutsideThread& operator=(const OutsideThread&) = delete;

  // Never waits: false where too much waits already. `handing` must not throw; what it refers to must outlive the
  // program's last wait for it.
  bool hand(std::function<void()> handing);
  // Whether all was taken in this time.
  bool waitUntilTaken(std::chrono::milliseconds longest = patience);

 private:
  // The thread's as well: it may be left behind.
  struct Queue {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::function<void()>> waiting;
    bool is_handing = false, stopping = false;
  };
  static void run(const std::shared_ptr<Queue>& queue);

  std::shared_ptr<Queue> queue_ = std::make_shared<Queue>();
};

}  // namespace edgeslam
