// From Ros2Publisher::frame() to a subscriber of another implementation of DDS, and what is lost on the way. Two
// processes:
//   ros2_latency receive COUNT         until all are there, or nothing has come for 10 s; then prints the figures
//   ros2_latency publish COUNT RATE_HZ
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "drivers/lcm/clocks.h"
#include "drivers/ros2/ros2_publisher.h"
#include "system/ros2/fast_dds.h"

namespace edgeslam {
namespace {

// Of sorted values.
double percentile(const std::vector<double>& values, double share) {
  const auto index = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(index, 1) - 1];
}

void printLatencies(const char* what, std::vector<double> values_us) {
  if (values_us.empty()) return;
  std::sort(values_us.begin(), values_us.end());
  std::printf("%s: p50 %.0f us, p90 %.0f us, p99 %.0f us, p99.9 %.0f us, max %.0f us\n", what,
              percentile(values_us, 0.5), percentile(values_us, 0.9), percentile(values_us, 0.99),
              percentile(values_us, 0.999), values_us.back());
}

int receive(std::size_t count) {
  FastDdsParticipant participant;
  std::vector<double> latencies_us;
  latencies_us.reserve(count);
  FastDdsReader<decoded::Odometry> reader(participant, "rt/odom", {}, [&](const decoded::Odometry& odometry) {
    latencies_us.push_back(static_cast<double>(realUtime() - odometry.header.stamp_ns() / 1000));
  });
  std::puts("ready");
  std::fflush(stdout);
  std::size_t before = 0;
  for (int quiet_s = 0; quiet_s < (before == 0 ? 60 : 10) && reader.count() < count; ++quiet_s) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    if (reader.count() != before) quiet_s = 0;
    before = reader.count();
  }
  printLatencies("publish to receive", latencies_us);
  std::printf("received %zu of %zu, %d wrong\n", reader.count(), count, reader.wrong());
  return reader.count() == count ? 0 : 1;
}

int publish(int count, double rate_hz) {
  using Clock = std::chrono::steady_clock;
  Ros2Publisher publisher({}, 0);
  std::this_thread::sleep_for(std::chrono::seconds(3));  // for discovery
  SentFrame sent{};
  sent.odometry.emplace();
  sent.odometry->odometry.orientation[0] = 1;
  std::vector<double> call_us;
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_until(
        start + i * std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_hz)));
    sent.frame.state.utime = monotonicUtime();
    const Clock::time_point called = Clock::now();
    publisher.frame(sent);
    call_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - called).count());
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));  // for what is to be sent again
  printLatencies("the publisher's call", call_us);
  while (const std::optional<std::string> event = publisher.nextEvent()) std::puts(event->c_str());
  return 0;
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "receive" && argc == 3) return edgeslam::receive(std::strtoul(argv[2], nullptr, 10));
  if (mode == "publish" && argc == 4) return edgeslam::publish(std::atoi(argv[2]), std::atof(argv[3]));
  std::fputs("usage: ros2_latency receive COUNT | publish COUNT RATE_HZ\n", stderr);
  return 2;
}
