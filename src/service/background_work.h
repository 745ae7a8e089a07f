// Work that may wait for the disk, done in a thread of its own at low priority, one piece after the other.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace edgeslam {

class BackgroundWork {
 public:
  // What is to be done afterwards, by the thread that calls complete().
  using Completion = std::function<void()>;
  // Must not throw.
  using Work = std::function<Completion()>;

  BackgroundWork();
  // Does what still waits; completions are not run.
  ~BackgroundWork();
  BackgroundWork(const BackgroundWork&) = delete;
  BackgroundWork& operator=(const BackgroundWork&) = delete;

  void begin(Work work);
  // Runs the completions of what was done since.
  void complete();
  // Waits until all is done.
  void finish();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Work> waiting_;
  std::vector<Completion> done_;
  bool working_ = false, stopping_ = false;
  std::thread thread_;
};

}  // namespace edgeslam
