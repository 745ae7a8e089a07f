// The flight recorder's thread: takes what the run hands over and writes it, without ever making the run wait. Where it
// falls behind, it writes frames as they are, which takes a tenth of the work and twice the room. What waits is bounded
// by the memory that it holds.
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "image_formats/jpeg_decoder.h"
#include "inertia/inertial_unit.h"
#include "map/keyframe.h"
#include "recording/recording_writer.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

// A frame or a decision on its way to the recorder. Copying it neither allocates nor copies pixels.
struct RecordingEntry {
  DecisionKind kind = DecisionKind::frame;    // any but `gap`, `stopped` and `end`, which the thread writes itself
  std::shared_ptr<const FrameImages> images;  // of a frame; null where there is the JPEG
  CameraJpeg jpeg;                            // of a frame, as the camera sent it; otherwise null
  std::int64_t index = 0;                     // as in Decision
  std::int64_t time_ns = 0;
  std::int64_t number = 0;
  std::array<char, 160> reason{};            // of an unreadable frame: up to the first zero
  std::array<InertialSample, 16> samples{};  // of kind `inertia`: the first `number` of them
  std::array<OdometryPose, 8> poses{};       // likewise of kind `wheels`
};

// Cuts off what does not fit.
RecordingEntry unreadableFrameEntry(std::int64_t index, std::int64_t time_ns, std::string_view reason);

// Of images of 640 x 480 pixels these are 4 s at 60 frames/s and 8 s at 30. One image may always wait.
struct QueueCapacity {
  std::size_t entries = 1024;
  std::int64_t image_bytes = 100 << 20;  // as the camera sent them, or with all levels of their pyramids
};

class RecordingThread {
 public:
  // Opens the recording (RecordingWriter::open, which may throw InputError) and starts the thread, at nice 5.
  // `capacity`: what may wait for it.
  RecordingThread(const std::string& folder, const RecordingDescription& description,
                  const RecordingLimits& limits = {}, const QueueCapacity& capacity = {});
  // stop()
  ~RecordingThread();
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;
  RecordingThread(RecordingThread&&) = delete;
  RecordingThread& operator=(RecordingThread&&) = delete;

  // Hands an entry over. Wait-free: no lock, no system call, no allocation. False where the queue is full: the entry is
  // lost, and the recording tells how many were lost at this place. True says nothing of the disk: see status(). Call
  // it from one thread only.
  bool post(RecordingEntry entry) noexcept;

  // How it goes, entries lost in post() included. Takes a lock, which post() does not: for the thread that reports.
  RecordingStatus status() const;

  // Writes for up to 3 s what still waits, then the clean end, and joins the thread (a write that the disk holds up is
  // waited for). What was left is a gap of the recording and told. Call it when post() is called no more; further calls
  // only return the status.
  RecordingStatus stop();

 private:
  struct QueuedEntry {
    RecordingEntry entry;
    std::int64_t lost_before = 0;  // entries lost between the one before and this one
    std::int64_t image_bytes = 0;
  };

  void run();
  void writeUntilStopped();
  void write(const QueuedEntry& queued);
  void writeEnd();
  void writeLost(std::int64_t count);
  void publishStatus();

  boost::lockfree::spsc_queue<QueuedEntry> queue_;
  const std::int64_t most_image_bytes_;
  std::atomic<std::int64_t> image_bytes_{0};  // in the queue
  std::int64_t lost_before_next_ = 0;         // the posting thread's
  std::atomic<std::int64_t> lost_{0};         // in post(), ever
  std::atomic<bool> stop_{false};

  RecordingWriter writer_;         // from here on the recorder's thread alone
  std::int64_t lost_written_ = 0;  // of those lost, what decisions.txt tells

  mutable std::mutex status_mutex_;  // of the two below
  RecordingStatus status_;
  std::int64_t lost_in_status_ = 0;

  std::thread thread_;
};

}  // namespace edgeslam
