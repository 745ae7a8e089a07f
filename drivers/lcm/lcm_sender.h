// Sends messages over LCM and goes on when the network does not: what cannot be sent is counted and forgotten.
#pragma once

#include <lcm/lcm.h>
#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/channel.h"

namespace edgeslam {

struct CloseLcm {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using LcmHandle = std::unique_ptr<lcm_t, CloseLcm>;

// Null where it cannot be opened; `problem` says why. Looks for a multicast route first, so that LCM does not write its
// page of advice to the standard error each time.
LcmHandle openLcm(const std::string& url, std::string& problem);

// How long to wait before the next try: twice as long each time, from 0.1 to 5 s.
class BackOff {
 public:
  using Clock = std::chrono::steady_clock;
  bool due(Clock::time_point now) const { return now >= next_; }
  void failed(Clock::time_point now);
  void reset();

 private:
  Clock::time_point next_{};
  Clock::duration wait_ = std::chrono::milliseconds(100);
};

// A thread of its own sends, so that a caller never waits: a slow link blocks the sender for seconds. What has waited
// for over 0.5 s is left out and counted: the newest messages win.
class LcmSender {
 public:
  // `url` from effectiveUrl(). `real_time_priority` of the thread: SCHED_FIFO, 1 to 99, where it is allowed; 0: the
  // usual scheduling.
  explicit LcmSender(std::string url, int real_time_priority = 0);
  // Sends what waits, for at most 0.5 s or until the message that is being sent is out.
  ~LcmSender();
  LcmSender(const LcmSender&) = delete;
  LcmSender& operator=(const LcmSender&) = delete;

  // For one thread. `Message`: a class by lcm-gen.
  template <class Message>
  void send(const std::string& channel, const Message& message) {
    Packet* packet = claim();
    if (!packet) return;
    packet->channel = channel;
    packet->bytes.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(packet->bytes.data(), 0, static_cast<int>(packet->bytes.size()));
    handOver(packet);
  }

  // As of now; messages that wait are not counted yet.
  std::int64_t sent() const { return sent_.load(std::memory_order_relaxed); }
  std::int64_t notSent() const { return not_sent_.load(std::memory_order_relaxed); }
  // How often sending worked again after it had not.
  std::int64_t comebacks() const { return comebacks_.load(std::memory_order_relaxed); }
  // Why messages do not go out at present, in one line; empty where they do.
  std::string problem() const;

 private:
  struct Packet {
    std::string channel;
    std::vector<std::uint8_t> bytes;
    BackOff::Clock::time_point handed_over;
  };

  Packet* claim();
  void leaveOut();
  void handOver(Packet* packet);
  void run();
  void deliver(const Packet& packet);
  bool publish(const Packet& packet);
  void openWhenDue();
  void setProblem(const std::string& problem);

  const std::string url_;
  const int real_time_priority_;
  Channel<Packet> waiting_;
  sem_t handed_over_;
  std::atomic<bool> stopping_{false}, overflowed_{false};
  std::atomic<std::int64_t> sent_{0}, not_sent_{0}, comebacks_{0};
  mutable std::mutex problem_mutex_;  // taken where the problem changes and where it is asked for
  std::string problem_;

  LcmHandle lcm_;  // these are the thread's
  BackOff back_off_;
  bool failing_ = false;
  std::thread thread_;
};

}  // namespace edgeslam
