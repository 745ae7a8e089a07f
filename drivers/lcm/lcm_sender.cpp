#include "drivers/lcm/lcm_sender.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "drivers/lcm/lcm_options.h"

namespace edgeslam {

LcmHandle openLcm(const std::string& url, std::string& problem) {
  if (const std::optional<MulticastGroup> group = multicastGroup(url)) {
    problem = multicastRouteProblem(*group);
    if (!problem.empty()) return nullptr;
  }
  LcmHandle lcm(lcm_create(url.c_str()));
  if (!lcm) problem = "LCM: " + url + " cannot be opened";
  return lcm;
}

void BackOff::failed(Clock::time_point now) {
  next_ = now + wait_;
  wait_ = std::min<Clock::duration>(2 * wait_, std::chrono::seconds(5));
}

void BackOff::reset() { *this = BackOff(); }

void LcmSender::sendBuffer(const std::string& channel) {
  const bool failed_before = !problem_.empty();
  if (!publish(channel)) {
    ++not_sent_;
    openWhenDue();
    return;
  }
  ++sent_;
  if (!failed_before) return;
  ++comebacks_;
  problem_.clear();
  back_off_.reset();
}

bool LcmSender::publish(const std::string& channel) {
  if (!lcm_) openWhenDue();
  if (!lcm_) return false;
  errno = 0;
  if (lcm_publish(lcm_.get(), channel.c_str(), buffer_.data(), static_cast<unsigned>(buffer_.size())) == 0) return true;
  problem_ = "LCM: " + url_ + ": messages cannot be sent (" + std::strerror(errno) + ")";
  return false;
}

// An open one that fails is kept until a new one can be opened: it may come back by itself.
void LcmSender::openWhenDue() {
  const BackOff::Clock::time_point now = BackOff::Clock::now();
  if (!back_off_.due(now)) return;
  back_off_.failed(now);
  std::string problem;
  LcmHandle opened = openLcm(url_, problem);
  if (opened) {
    lcm_ = std::move(opened);
  } else {
    problem_ = problem;
  }
}

}  // namespace edgeslam
