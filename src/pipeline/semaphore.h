// A semaphore of the system: posting it neither waits nor locks, so that tracking's thread may.
#pragma once

#include <semaphore.h>

#include <cstdint>

namespace edgeslam {

class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() { sem_post(&semaphore_); }
  void wait();
  // Until the steady clock says so, at the latest.
  void waitUntil(std::int64_t steady_ns);

 private:
  sem_t semaphore_;
};

}  // namespace edgeslam
