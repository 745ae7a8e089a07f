// Listens for commands in a thread of its own: opening LCM for receiving may take seconds.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "drivers/lcm/commands.h"
#include "drivers/lcm/lcm_sender.h"

namespace edgeslam {

class CommandReceiver {
 public:
  // `url` from effectiveUrl(), one that canReceive().
  CommandReceiver(std::string url, std::string channel);
  // Within 0.2 s; where the network has just swallowed LCM's own test message, within 10 s.
  ~CommandReceiver();
  CommandReceiver(const CommandReceiver&) = delete;
  CommandReceiver& operator=(const CommandReceiver&) = delete;

  // The oldest that waits, or none. One thread's alone.
  std::optional<CheckedCommand> next();

  // Messages that were no command, and commands for which the queue was full.
  std::int64_t ignored() const { return ignored_.load(std::memory_order_relaxed); }
  // The network was away: joins the multicast group anew.
  void joinAnew() { join_anew_.store(true, std::memory_order_release); }
  // True from when commands are heard.
  bool listening() const { return listening_.load(std::memory_order_acquire); }

 private:
  static void received(const lcm_recv_buf_t* buffer, const char* channel, void* receiver);
  void take(const lcm_recv_buf_t& buffer);
  void listen();
  LcmHandle open();

  std::string url_, channel_;
  boost::lockfree::spsc_queue<CheckedCommand, boost::lockfree::capacity<16>> waiting_;
  std::atomic<std::int64_t> ignored_{0};
  std::atomic<bool> stopping_{false}, join_anew_{false}, listening_{false};
  std::thread thread_;
};

}  // namespace edgeslam
