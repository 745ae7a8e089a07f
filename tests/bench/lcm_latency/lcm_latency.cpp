// From LcmPublisher::frame() to a subscriber's handler, and what is lost on the way. Two processes:
//   lcm_latency receive         until nothing has come for 3 s; then prints the figures
//   lcm_latency publish COUNT RATE_HZ
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <thread>
#include <vector>

#include "drivers/lcm/clocks.h"
#include "drivers/lcm/lcm_publisher.h"
#include "drivers/lcm/messages.h"

namespace edgeslam {
namespace {

// Of sorted values.
double percentile(const std::vector<double>& values, double share) {
  const auto index = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(index, 1) - 1];
}

void printLatencies(const char* what, std::vector<double> values_us) {
  std::sort(values_us.begin(), values_us.end());
  std::printf("%s: p50 %.0f us, p90 %.0f us, p99 %.0f us, p99.9 %.0f us, max %.0f us\n", what,
              percentile(values_us, 0.5), percentile(values_us, 0.9), percentile(values_us, 0.99),
              percentile(values_us, 0.999), values_us.back());
}

class Receiver {
 public:
  void onState(const lcm::ReceiveBuffer*, const std::string&, const state_t* state) {
    latencies_us_.push_back(static_cast<double>(realUtime() - state->publish_utime));
    if (expected_ >= 0 && state->sequence > expected_) {
      lost_ += state->sequence - expected_;
      ++gaps_;
    }
    expected_ = state->sequence + 1;
  }
  void onPose(const lcm::ReceiveBuffer*, const std::string&, const pose_t*) { ++poses_; }

  std::size_t received() const { return latencies_us_.size(); }
  void print() const {
    printLatencies("publish to receive", latencies_us_);
    std::printf("states: %zu received, %lld lost in %lld gaps; poses: %lld received\n", received(),
                static_cast<long long>(lost_), static_cast<long long>(gaps_), static_cast<long long>(poses_));
  }

 private:
  std::vector<double> latencies_us_;
  std::int64_t expected_ = 0, lost_ = 0, gaps_ = 0, poses_ = 0;
};

int receive() {
  lcm::LCM lcm;
  Receiver receiver;
  lcm.subscribe("SLAM_STATE", &Receiver::onState, &receiver)->setQueueCapacity(10000);
  lcm.subscribe("SLAM_POSE", &Receiver::onPose, &receiver)->setQueueCapacity(10000);
  std::puts("ready");
  std::fflush(stdout);
  while (receiver.received() == 0) {
    if (lcm.handleTimeout(30000) <= 0) return 1;
  }
  while (lcm.handleTimeout(3000) > 0) continue;
  receiver.print();
  return 0;
}

int publish(int count, double rate_hz) {
  using Clock = std::chrono::steady_clock;
  LcmPublisher publisher({}, Pose());
  FrameResult frame;
  frame.state = TrackingState::tracking;
  frame.has_pose = true;
  frame.covariance.setIdentity();
  std::vector<double> call_us;
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_until(
        start + i * std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_hz)));
    frame.index = i;
    frame.time_ns = 1000 * monotonicUtime();
    const Clock::time_point called = Clock::now();
    publisher.frame(frame);
    call_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - called).count());
  }
  while (publisher.counts().sent + publisher.counts().not_sent < 3LL * count) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  printLatencies("the publisher's call", call_us);
  std::printf("messages: %lld sent, %lld not\n", static_cast<long long>(publisher.counts().sent),
              static_cast<long long>(publisher.counts().not_sent));
  return 0;
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "receive" && argc == 2) return edgeslam::receive();
  if (mode == "publish" && argc == 4) return edgeslam::publish(std::atoi(argv[2]), std::atof(argv[3]));
  std::fputs("usage: lcm_latency receive | publish COUNT RATE_HZ\n", stderr);
  return 2;
}
