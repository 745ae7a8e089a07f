#include "app/camera_recording.h"

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <thread>
#include <utility>

namespace edgeslam {
namespace {

struct StampedImage {
  std::int64_t time_ns = 0;
  cv::Mat grey;
};

// Writes what it is handed, in a thread of its own.
class WritingThread {
 public:
  WritingThread(FrameFolderWriter& writer, std::size_t capacity)
      : writer_(writer), queue_(capacity), thread_([this] { run(); }) {}
  ~WritingThread() { stop(); }
  WritingThread(const WritingThread&) = delete;
  WritingThread& operator=(const WritingThread&) = delete;

  bool post(StampedImage image) { return queue_.push(std::move(image)); }
  bool failed() const { return failed_; }
  // Writes what still waits.
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void run() {
    StampedImage image;
    while (true) {
      const bool last = stop_;  // before looking, so that what came before the stop is written
      while (queue_.pop(image)) {
        if (!failed_ && !writer_.write(image.time_ns, image.grey).empty()) failed_ = true;
      }
      if (last) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  FrameFolderWriter& writer_;
  boost::lockfree::spsc_queue<StampedImage> queue_;
  std::atomic<bool> stop_{false}, failed_{false};
  std::thread thread_;
};

}  // namespace

CameraRecordingResult recordCamera(LiveCamera& camera, FrameFolderWriter& writer, const CameraRecordingLimits& limits,
                                   const std::function<bool()>& stop,
                                   const std::function<void(const std::string&)>& tell,
                                   const std::function<void(const CameraRecordingCounts&)>& progress) {
  CameraRecordingResult result;
  CameraRecordingCounts& counts = result.counts;
  WritingThread writing(writer, limits.waiting_frames);
  std::int64_t first_ns = -1, posted = 0;
  while (!stop() && !writing.failed()) {
    cv::Mat grey;  // anew for each frame, as the writing thread keeps it
    const Capture capture = camera.next(grey, std::chrono::milliseconds(100));
    if (capture.event == CaptureEvent::ended) break;
    if (capture.event == CaptureEvent::interrupted) {
      ++counts.interruptions;
      tell(capture.message);
    }
    if (capture.event == CaptureEvent::damaged_frame && counts.damaged++ == 0) {
      tell(capture.message + " (left out; more of them are only counted)");
    }
    if (capture.event != CaptureEvent::frame) continue;

    const CapturedFrame& frame = capture.frame;
    if (first_ns < 0) first_ns = frame.time_ns;
    if (limits.duration_ns > 0 && frame.time_ns - first_ns >= limits.duration_ns) break;
    if (frame.after_interruption) tell("the camera is back");
    counts.lost_by_driver += frame.lost_before;
    counts.duration_ns = frame.time_ns - first_ns;
    counts.arrival_stamps += frame.time_meaning == TimeMeaning::arrival ? 1 : 0;
    if (writing.post({frame.time_ns, grey})) {
      ++posted;
    } else {
      ++counts.lost_by_disk;
    }
    counts.written = posted;
    progress(counts);
    if (limits.frames > 0 && posted >= limits.frames) break;
  }
  writing.stop();
  result.problem = writer.close();
  counts.written = writer.frames();
  return result;
}

}  // namespace edgeslam
