// Uses both classes of the installed library, and gets its errors as exceptions across the library's border.
//
//     edgeslam_user CONFIGURATION
#include <edgeslam/live_slam.h>
#include <edgeslam/slam.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>

namespace {

constexpr std::int64_t first_ns = 1'000'000'000, interval_ns = 33'000'000;
constexpr int frame_count = 10;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "edgeslam_user: expected: %s\n", what);
  std::exit(1);
}

void expectInputError(const std::function<void()>& call, const char* what) {
  try {
    call();
  } catch (const edgeslam::InputError& error) {
    return expect(error.what()[0] != '\0', "a message");
  }
  expect(false, what);
}

// Squares that move to the right by 2 px a frame.
std::vector<std::uint8_t> frame(int index, int width, int height) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) pixels.push_back(((x - 2 * index + 64) / 24 + y / 24) % 2 == 0 ? 60 : 180);
  }
  return pixels;
}

void trackInThisThread(const char* configuration) {
  edgeslam::Slam slam(configuration);
  const int width = slam.width(), height = slam.height();
  for (int i = 0; i < frame_count; ++i) {
    const std::vector<std::uint8_t> pixels = frame(i, width, height);
    const edgeslam::PosedFrame posed = slam.process({pixels.data(), width, height, width}, first_ns + i * interval_ns);
    expect(posed.index == i && posed.time_ns == first_ns + i * interval_ns, "frames in order");
    if (i > 0) expect(posed.tracked_points > 0, "points that are followed");
  }
  const std::vector<std::uint8_t> pixels = frame(0, width, height);
  expectInputError([&] { slam.process({pixels.data(), width, height, width}, first_ns); }, "a refused time stamp");
  expectInputError([&] { slam.process({pixels.data(), width, height - 1, width}, 2 * first_ns); }, "a refused size");
  slam.finish();
}

void trackInThreads(const char* configuration) {
  std::atomic<int> received{0};
  edgeslam::LiveSlam slam(configuration, [&](const edgeslam::PosedFrame&) { ++received; });
  for (int i = 0; i < frame_count; ++i) {
    const std::vector<std::uint8_t> pixels = frame(i, slam.width(), slam.height());
    slam.handOver({pixels.data(), slam.width(), slam.height(), slam.width()}, first_ns + i * interval_ns);
  }
  slam.stop();
  const edgeslam::LiveCounters counters = slam.counters();
  expect(counters.handed_over == frame_count, "all frames handed over");
  expect(counters.processed >= 1 && counters.processed + counters.passed_over == frame_count,
         "all frames accounted for");
  expect(received == counters.processed, "a pose for each frame that was processed");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: edgeslam_user CONFIGURATION\n");
    return 2;
  }
  expectInputError([] { edgeslam::Slam("/none/such.yaml"); }, "a refused configuration");
  trackInThisThread(argv[1]);
  trackInThreads(argv[1]);
  std::puts("ok");
  return 0;
}
