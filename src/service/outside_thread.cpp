#include "service/outside_thread.h"

#include <signal.h>

#include <thread>
#include <utility>

namespace edgeslam {

OutsideThread::OutsideThread() {
  // The program's signals are for those who wait for them.
  sigset_t all{}, before{};
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  std::thread([queue = queue_] { run(queue); }).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

OutsideThread::~OutsideThread() {
  waitUntilTaken();
  {
    const std::lock_guard<std::mutex> lock(queue_->mutex);
    queue_->stopping = true;
    queue_->waiting.clear();
  }
  queue_->changed.notify_all();
}

bool OutsideThread::hand(std::function<void()> handing) {
  {
    const std::lock_guard<std::mutex> lock(queue_->mutex);
    if (queue_->waiting.size() == most_waiting) return false;
    queue_->waiting.push_back(std::move(handing));
  }
  queue_->changed.notify_all();
  return true;
}

bool OutsideThread::waitUntilTaken(std::chrono::milliseconds longest) {
  std::unique_lock<std::mutex> lock(queue_->mutex);
  return queue_->changed.wait_for(lock, longest, [this] { return queue_->waiting.empty() && !queue_->is_handing; });
}

void OutsideThread::run(const std::shared_ptr<Queue>& queue) {
  std::unique_lock<std::mutex> lock(queue->mutex);
  while (true) {
    queue->changed.wait(lock, [&queue] { return queue->stopping || !queue->waiting.empty(); });
    if (queue->waiting.empty()) return;
    const std::function<void()> handing = std::move(queue->waiting.front());
    queue->waiting.pop_front();
    queue->is_handing = true;
    lock.unlock();
    handing();
    lock.lock();
    queue->is_handing = false;
    queue->changed.notify_all();
  }
}

}  // namespace edgeslam
