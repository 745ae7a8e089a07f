#include "drivers/replay/replay_camera.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "frames/image_file.h"

namespace edgeslam {
namespace {

class ReplayCamera : public LiveCamera {
 public:
  ReplayCamera(std::unique_ptr<FrameSource> source, std::deque<Frame> read, const StreamDescription& stream,
               ReplayPace pace)
      : source_(std::move(source)), waiting_(std::move(read)), stream_(stream), pace_(std::move(pace)) {}

  Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) override {
    if (waiting_.empty()) {
      std::optional<Frame> frame = source_->next();
      if (!frame) return {CaptureEvent::ended, {}, ""};
      waiting_.push_back(std::move(*frame));
    }
    if (!waitForItsTime(waiting_.front().time_ns, timeout.count())) return {};
    const Frame frame = std::move(waiting_.front());
    waiting_.pop_front();

    Capture capture{CaptureEvent::frame, {}, frame.problem};
    capture.frame.time_ns = frame.time_ns;
    capture.frame.time_meaning = TimeMeaning::exposure_middle;
    capture.frame.sequence = frame.index;
    capture.frame.lost_before = std::max<std::int64_t>(frame.index - last_index_ - 1, 0);
    last_index_ = frame.index;
    if (capture.message.empty()) {
      capture.message = sizeProblem(frame.grey.size(), {stream_.width, stream_.height}, "expected are");
    }
    if (capture.message.empty()) {
      frame.grey.copyTo(grey);
    } else {
      capture.event = CaptureEvent::damaged_frame;
    }
    return capture;
  }

  const StreamDescription& stream() const override { return stream_; }

 private:
  // True where the frame is due within `timeout_ns`; then it is due now.
  bool waitForItsTime(std::int64_t time_ns, std::int64_t timeout_ns) {
    if (!pace_.by_time_stamps) return true;
    const std::int64_t now_ns = pace_.now_ns();
    if (!started_) {
      started_ = true;
      offset_ns_ = now_ns - time_ns;
    }
    const std::int64_t left_ns = time_ns + offset_ns_ - now_ns;
    if (left_ns > 0) pace_.sleep_ns(std::min(left_ns, std::max<std::int64_t>(timeout_ns, 0)));
    return left_ns <= timeout_ns || left_ns <= 0;
  }

  std::unique_ptr<FrameSource> source_;
  std::deque<Frame> waiting_;  // read and not given yet
  StreamDescription stream_;
  ReplayPace pace_;
  bool started_ = false;
  std::int64_t offset_ns_ = 0;  // from the recording's time to ours
  std::int64_t last_index_ = -1;
};

}  // namespace

OpenedCamera openReplayCamera(std::unique_ptr<FrameSource> source, const std::string& name, cv::Size size,
                              const ReplayPace& pace) {
  constexpr std::size_t most_unreadable = 100;  // at the beginning
  StreamDescription stream{name, source->kind(), size.width, size.height, 0, true};
  std::deque<Frame> read;
  std::int64_t first_ns = 0;
  std::size_t readable = 0;
  // Two frames also tell the interval between them.
  while (readable < 2 && read.size() < most_unreadable) {
    std::optional<Frame> frame = source->next();
    if (!frame) break;
    if (frame->problem.empty() && ++readable == 1) {
      if (size.empty()) size = frame->grey.size();
      first_ns = frame->time_ns;
    } else if (frame->problem.empty()) {
      stream.frame_interval_ns = frame->time_ns - first_ns;
    }
    read.push_back(std::move(*frame));
  }
  if (readable == 0) {
    return {nullptr, name + ": no frame can be read" + (read.empty() ? "" : ": " + read.front().problem), false};
  }
  stream.width = size.width;
  stream.height = size.height;
  stream.format += ", " + std::to_string(size.width) + " x " + std::to_string(size.height);
  return {std::make_unique<ReplayCamera>(std::move(source), std::move(read), stream, pace), "", false};
}

}  // namespace edgeslam
