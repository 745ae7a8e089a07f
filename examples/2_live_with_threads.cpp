// As on a robot: frames are handed over as they come, and poses arrive in another thread.
//
//     2_live_with_threads CONFIGURATION FOLDER
#include <edgeslam/live_slam.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "pgm_folder.h"

namespace {

// Called in a thread of the library's, for each frame in order. It must not throw, and should not take long.
void onPose(const edgeslam::PosedFrame& frame) {
  const auto& p = frame.pose.position;
  if (frame.isGood()) {
    std::printf("%.3f s: %.3f %.3f %.3f, %.1f ms\n", 1e-9 * static_cast<double>(frame.time_ns), p[0], p[1], p[2],
                frame.latency_ms);
  } else {
    std::printf("%.3f s: no good pose: %s\n", 1e-9 * static_cast<double>(frame.time_ns), frame.reason.c_str());
  }
}

void track(const char* configuration, const char* folder) {
  edgeslam::LiveSlam slam(configuration, onPose, [](const std::string& event) { std::printf("%s\n", event.c_str()); });
  for (const std::string& problem : slam.problems()) std::fprintf(stderr, "%s\n", problem.c_str());

  const std::vector<TimedFile> files = pgmFiles(folder);
  const auto start = std::chrono::steady_clock::now();
  for (const TimedFile& file : files) {
    const PgmImage image = readPgm(file.path);
    std::this_thread::sleep_until(start + std::chrono::nanoseconds(file.time_ns - files.front().time_ns));
    slam.handOver(image.view(), file.time_ns);  // copies it and never waits
  }
  slam.stop();
  const edgeslam::LiveCounters counters = slam.counters();
  std::printf("%lld frames, %lld passed over, %zu keyframes, %zu points\n",
              static_cast<long long>(counters.handed_over), static_cast<long long>(counters.passed_over),
              counters.keyframes, counters.points);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw edgeslam::InputError("usage: 2_live_with_threads CONFIGURATION FOLDER");
  track(argv[1], argv[2]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "2_live_with_threads: %s\n", error.what());
  return 2;
}
