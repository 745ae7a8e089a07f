// Publishes what a sensor measured on a simulated way, always a little ahead of the frames that were heard.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "system/daemon/robot.h"

namespace edgeslam {

// Of each sample a function timeOf() tells its time [ns].
template <typename Sample>
class BesideFrames {
 public:
  using Publish = std::function<void(lcm::LCM&, const Sample&, std::size_t index)>;

  BesideFrames(const Robot& robot, std::vector<Sample> samples, Publish publish)
      : robot_(robot), samples_(std::move(samples)), publish_(std::move(publish)), thread_([this] {
          while (!stopping_) publishDue();
        }) {}
  ~BesideFrames() {
    stopping_ = true;
    thread_.join();
  }
  BesideFrames(const BesideFrames&) = delete;
  BesideFrames& operator=(const BesideFrames&) = delete;

 private:
  void publishDue() {
    constexpr std::int64_t ahead_us = 150'000;
    const std::int64_t frame_us = robot_.latestUtime();
    for (; next_ < samples_.size() && timeOf(samples_[next_]) / 1000 <= frame_us + ahead_us; ++next_) {
      publish_(lcm_, samples_[next_], next_);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  const Robot& robot_;
  std::vector<Sample> samples_;
  Publish publish_;
  std::size_t next_ = 0;
  lcm::LCM lcm_{"udpm://239.255.76.67:7667?ttl=0"};
  std::atomic<bool> stopping_{false};
  std::thread thread_;  // last: it uses the others
};

}  // namespace edgeslam
