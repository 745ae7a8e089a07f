// Listens to a channel in a thread of its own: opening LCM for receiving may take seconds.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "drivers/lcm/lcm_sender.h"

namespace edgeslam {

class LcmListener {
 public:
  // Called by the thread, for every message.
  using Take = std::function<void(const void* data, std::size_t bytes)>;

  // `url` from effectiveUrl(), one that canReceive(). `thread_name`: at most 15 letters.
  LcmListener(std::string url, std::string channel, const char* thread_name, Take take);
  // Within 0.2 s; where the network has just swallowed LCM's own test message, within 10 s.
  ~LcmListener();
  LcmListener(const LcmListener&) = delete;
  LcmListener& operator=(const LcmListener&) = delete;

  // The network was away: joins the multicast group anew.
  void joinAnew() { join_anew_.store(true, std::memory_order_release); }
  // True from when messages are heard.
  bool listening() const { return listening_.load(std::memory_order_acquire); }

 private:
  static void received(const lcm_recv_buf_t* buffer, const char* channel, void* listener);
  void listen(const char* thread_name);
  LcmHandle open();

  std::string url_, channel_;
  Take take_;
  std::atomic<bool> stopping_{false}, join_anew_{false}, listening_{false};
  std::thread thread_;
};

}  // namespace edgeslam
