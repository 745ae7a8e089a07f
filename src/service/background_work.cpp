#include "service/background_work.h"

#include <utility>

#include "pipeline/thread_setup.h"

namespace edgeslam {

BackgroundWork::BackgroundWork() : thread_([this] { run(); }) {}

BackgroundWork::~BackgroundWork() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundWork::begin(Work work) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(work));
  }
  changed_.notify_all();
}

void BackgroundWork::complete() {
  std::vector<Completion> done;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done.swap(done_);
  }
  for (const Completion& completion : done) {
    if (completion) completion();
  }
}

void BackgroundWork::finish() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !working_; });
}

void BackgroundWork::run() {
  setUpThread({"background", 0, 10, false, {}});
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const Work work = std::move(waiting_.front());
    waiting_.pop_front();
    working_ = true;
    lock.unlock();
    Completion completion = work();
    lock.lock();
    working_ = false;
    done_.push_back(std::move(completion));
    changed_.notify_all();
  }
}

}  // namespace edgeslam
