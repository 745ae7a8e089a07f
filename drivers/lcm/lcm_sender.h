// Sends messages over LCM and goes on when the network does not: what cannot be sent is counted and forgotten.
#pragma once

#include <lcm/lcm.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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

class LcmSender {
 public:
  // `url` from effectiveUrl(). Opens when the first message is sent.
  explicit LcmSender(std::string url) : url_(std::move(url)) {}

  // `Message`: a class by lcm-gen.
  template <class Message>
  void send(const std::string& channel, const Message& message) {
    buffer_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
    sendBuffer(channel);
  }

  std::int64_t sent() const { return sent_; }
  std::int64_t notSent() const { return not_sent_; }
  // How often sending worked again after it had not.
  std::int64_t comebacks() const { return comebacks_; }
  // Why the last message was not sent, in one line; empty where it was.
  const std::string& problem() const { return problem_; }

 private:
  void sendBuffer(const std::string& channel);
  bool publish(const std::string& channel);
  void openWhenDue();

  std::string url_;
  LcmHandle lcm_;
  BackOff back_off_;
  std::vector<std::uint8_t> buffer_;
  std::string problem_;
  std::int64_t sent_ = 0, not_sent_ = 0, comebacks_ = 0;
};

}  // namespace edgeslam
