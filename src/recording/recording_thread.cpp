#include "recording/recording_thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

namespace edgeslam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto sync_interval = std::chrono::seconds(1);
constexpr auto drain_time = std::chrono::seconds(3);
constexpr auto idle_time = std::chrono::milliseconds(10);
constexpr int nice_level = 5;
constexpr std::size_t unhurried_backlog = 2;  // entries that wait: more, and frames are packed no more

// On Linux a thread has a nice level of its own. Lowering the priority needs no privilege, nor does leaving the
// real-time scheduling that the thread which starts this one may have.
void lowerPriority() {
  const sched_param usual{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &usual);
  pthread_setname_np(pthread_self(), "recorder");
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice_level);
}

std::int64_t imageBytes(const RecordingEntry& entry) {
  std::size_t bytes = entry.jpeg ? entry.jpeg->size() : 0;
  if (entry.images) {
    for (const cv::Mat& level : entry.images->pyramid.levels) bytes += level.total() * level.elemSize();
  }
  return static_cast<std::int64_t>(bytes);
}

}  // namespace

RecordingEntry unreadableFrameEntry(std::int64_t index, std::int64_t time_ns, std::string_view reason) {
  RecordingEntry entry;
  entry.kind = DecisionKind::unreadable;
  entry.index = index;
  entry.time_ns = time_ns;
  std::copy_n(reason.begin(), std::min(reason.size(), entry.reason.size() - 1), entry.reason.begin());
  return entry;
}

RecordingThread::RecordingThread(const std::string& folder, const RecordingDescription& description,
                                 const RecordingLimits& limits, const QueueCapacity& capacity)
    : queue_(capacity.entries), most_image_bytes_(capacity.image_bytes) {
  writer_.open(folder, description, limits);
  status_ = writer_.status();
  thread_ = std::thread([this] { run(); });
}

RecordingThread::~RecordingThread() { stop(); }

bool RecordingThread::post(RecordingEntry entry) noexcept {
  const std::int64_t bytes = imageBytes(entry);
  const std::int64_t before = image_bytes_.fetch_add(bytes, std::memory_order_relaxed);
  const bool has_room = bytes == 0 || before == 0 || before + bytes <= most_image_bytes_;
  if (has_room && queue_.push({std::move(entry), lost_before_next_, bytes})) {
    lost_before_next_ = 0;
    return true;
  }
  image_bytes_.fetch_sub(bytes, std::memory_order_relaxed);
  ++lost_before_next_;
  lost_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

RecordingStatus RecordingThread::status() const {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  RecordingStatus status = status_;
  if (status.recording) status.not_recorded += lost_.load(std::memory_order_relaxed) - lost_in_status_;
  return status;
}

RecordingStatus RecordingThread::stop() {
  stop_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
  return status();
}

void RecordingThread::run() {
  lowerPriority();
  try {
    writeUntilStopped();
    writeEnd();
    publishStatus();
  } catch (const std::exception& error) {  // no memory
    const std::lock_guard<std::mutex> lock(status_mutex_);
    status_.recording = false;
    status_.message = std::string("recording ended: ") + error.what();
  }
}

// Goes on taking entries where recording has ended, so that their images are let go.
void RecordingThread::writeUntilStopped() {
  Clock::time_point next_sync = Clock::now() + sync_interval;
  std::optional<Clock::time_point> deadline;
  QueuedEntry queued;
  while (true) {
    // Looked at before the queue: what was posted before stop() is in it then.
    const bool stopping = stop_.load(std::memory_order_acquire);
    if (stopping && !deadline) deadline = Clock::now() + drain_time;
    if (deadline && Clock::now() >= *deadline) return;
    if (queue_.pop(queued)) {
      write(queued);
      queued.entry.images.reset();
      queued.entry.jpeg.reset();
      image_bytes_.fetch_sub(queued.image_bytes, std::memory_order_relaxed);
      publishStatus();
    } else if (stopping) {
      return;
    } else {
      std::this_thread::sleep_for(idle_time);
    }
    if (Clock::now() >= next_sync) {
      writer_.sync();
      publishStatus();
      next_sync = Clock::now() + sync_interval;
    }
  }
}

void RecordingThread::write(const QueuedEntry& queued) {
  writeLost(queued.lost_before);
  const RecordingEntry& entry = queued.entry;
  if (entry.jpeg) {
    writer_.writeJpeg(entry.index, entry.time_ns, *entry.jpeg);
  } else if (entry.kind == DecisionKind::frame) {
    const FrameCode code = queue_.read_available() > unhurried_backlog ? FrameCode::plain : FrameCode::packed;
    writer_.writeFrame(entry.index, entry.time_ns, entry.images->pyramid.levels[0], code);
  } else if (entry.kind == DecisionKind::inertia) {
    for (std::int64_t i = 0; i < entry.number; ++i) {
      writer_.writeDecision(inertiaDecision(entry.index, entry.samples[static_cast<std::size_t>(i)]));
    }
  } else if (entry.kind == DecisionKind::wheels) {
    for (std::int64_t i = 0; i < entry.number; ++i) {
      writer_.writeDecision(wheelsDecision(entry.index, entry.poses[static_cast<std::size_t>(i)]));
    }
  } else {
    writer_.writeDecision({entry.kind, entry.index, entry.time_ns, entry.number, entry.reason.data()});
  }
}

// With what was lost in post() after the last entry, and what there is no time for.
void RecordingThread::writeEnd() {
  const auto left = static_cast<std::int64_t>(queue_.consume_all([](const QueuedEntry&) {}));
  writeLost(lost_.load(std::memory_order_relaxed) - lost_written_);
  if (left > 0) writer_.writeDecision({DecisionKind::gap, 0, 0, left, ""});
  writer_.close();
}

void RecordingThread::writeLost(std::int64_t count) {
  if (count == 0) return;
  writer_.writeDecision({DecisionKind::gap, 0, 0, count, ""});
  lost_written_ += count;
}

void RecordingThread::publishStatus() {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  status_ = writer_.status();
  lost_in_status_ = lost_written_;
}

}  // namespace edgeslam
