#include "drivers/lcm/lcm_listener.h"

#include <pthread.h>

#include <chrono>
#include <utility>

namespace edgeslam {
namespace {

constexpr int patience_ms = 100;  // how long a stop may go unnoticed

}  // namespace

LcmListener::LcmListener(std::string url, std::string channel, const char* thread_name, Take take)
    : url_(std::move(url)),
      channel_(std::move(channel)),
      take_(std::move(take)),
      thread_([this, thread_name] { listen(thread_name); }) {}

LcmListener::~LcmListener() {
  stopping_.store(true, std::memory_order_release);
  thread_.join();
}

void LcmListener::listen(const char* thread_name) {
  pthread_setname_np(pthread_self(), thread_name);
  LcmHandle lcm;
  BackOff back_off;
  while (!stopping_.load(std::memory_order_acquire)) {
    if (join_anew_.exchange(false)) lcm.reset();
    if (!lcm && back_off.due(BackOff::Clock::now())) {
      lcm = open();
      back_off.failed(BackOff::Clock::now());
    }
    listening_.store(lcm != nullptr, std::memory_order_release);
    if (!lcm) {
      std::this_thread::sleep_for(std::chrono::milliseconds(patience_ms));
    } else if (lcm_handle_timeout(lcm.get(), patience_ms) < 0) {
      lcm.reset();
    } else {
      back_off.reset();
    }
  }
  listening_.store(false, std::memory_order_release);
}

LcmHandle LcmListener::open() {
  std::string problem;
  LcmHandle lcm = openLcm(url_, problem);
  if (lcm && !lcm_subscribe(lcm.get(), channel_.c_str(), &LcmListener::received, this)) lcm.reset();
  return lcm;
}

void LcmListener::received(const lcm_recv_buf_t* buffer, const char*, void* listener) {
  static_cast<LcmListener*>(listener)->take_(buffer->data, buffer->data_size);
}

}  // namespace edgeslam
