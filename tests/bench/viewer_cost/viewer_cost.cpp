// What a page that is open costs tracking: a live run at 30 frames/s in which a client that takes all it gets comes and
// goes each two seconds. Prints the time of tracking a frame with and without it: the median, and, for a busy computer,
// the bound of the quickest tenth.
// usage: viewer_cost SEQUENCE...
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "drivers/viewer/viewer.h"
#include "frames/frame_source.h"
#include "pipeline/live_run.h"
#include "recording/open_frame_source.h"
#include "unit/viewer/raw_client.h"

namespace edgeslam {
namespace {

constexpr int frames_of_a_turn = 60;

// Reads the stream while it lives.
class Reader {
 public:
  explicit Reader(const std::string& address) : thread_([this, address] { read(address); }) {}
  ~Reader() {
    ended_ = true;
    thread_.join();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  void read(const std::string& address) {
    const RawClient client(address);
    client.send("GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
    while (!ended_) client.receive(1, 100);
  }

  std::atomic<bool> ended_{false};
  std::thread thread_;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? NAN : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void measure(const std::string& folder) {
  const std::unique_ptr<FrameSource> source = openFrameSource(folder);
  const Camera camera = *source->camera();
  ViewerOptions options;
  options.port = 0;
  Viewer viewer(options, {"", folder, camera, {}});
  std::vector<double> watched, alone;  // [ms]
  LiveRun* running = nullptr;
  LiveObserver observer;
  int ticks = 0;
  observer.frame = [&](const FrameResult& result, const std::string&) {
    viewer.frame(result);
    if (isGoodPose(result.state)) (viewer.isWatched() ? watched : alone).push_back(result.times.total());
  };
  observer.report = [&](const MappingReport& report) {
    if (report.map) viewer.map(report.map, 0);
  };
  observer.tick = [&] {
    if (viewer.isWatched() && ++ticks % 20 == 0) running->askForMap();
  };
  LiveRun run(camera, Settings(), LiveOptions(), observer, nullptr);
  running = &run;
  run.showTo(viewer.looks());
  run.start();
  std::unique_ptr<Reader> reader;
  auto next = std::chrono::steady_clock::now();
  int count = 0;
  while (const std::optional<Frame> frame = source->next()) {
    if (count++ % frames_of_a_turn == 0) {
      if (reader) {
        reader.reset();
      } else {
        reader = std::make_unique<Reader>(viewer.address());
      }
    }
    FrameSlot& slot = run.nextSlot();
    slot.index = frame->index;
    slot.time_ns = frame->time_ns;
    frame->grey.copyTo(slot.grey);
    std::this_thread::sleep_until(next += std::chrono::microseconds(33333));
    run.handOver();
  }
  run.stop(/*settle=*/false);
  const double with = quantile(watched, 0.5), without = quantile(alone, 0.5);
  std::printf(
      "%s: tracking a frame, median %.2f ms of %zu frames with a page open, %.2f ms of %zu without: %+.1f %%; "
      "the quickest tenth up to %.2f and %.2f ms\n",
      folder.c_str(), with, watched.size(), without, alone.size(), 100 * (with / without - 1), quantile(watched, 0.9),
      quantile(alone, 0.9));
}

}  // namespace
}  // namespace edgeslam

int main(int count, char** folders) {
  for (int i = 1; i < count; ++i) edgeslam::measure(folders[i]);
}
