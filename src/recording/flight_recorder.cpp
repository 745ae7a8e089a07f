#include "recording/flight_recorder.h"

#include <thread>
#include <utility>

namespace edgeslam {

RecordingLimits recordingLimits(const RecordingSpace& space) {
  const auto bytesOf = [](double megabytes) { return static_cast<std::int64_t>(megabytes * (1 << 20)); };
  return {bytesOf(space.most_megabytes), bytesOf(space.kept_free_megabytes)};
}

FlightRecorder::FlightRecorder(const std::string& folder, const RecordingDescription& description,
                               const RecordingLimits& limits)
    : folder_(folder),
      largest_image_(largestArchivedImage(description.camera.width, description.camera.height)),
      thread_(folder, description, limits) {
  inertia_.kind = DecisionKind::inertia;
  wheels_.kind = DecisionKind::wheels;
}

void FlightRecorder::mappingBusy(std::int64_t frame_index) noexcept {
  postNumbered(DecisionKind::busy, frame_index, 0);
}

void FlightRecorder::tookUpdate(std::int64_t frame_index, std::int64_t number) noexcept {
  postNumbered(DecisionKind::update, frame_index, number);
}

void FlightRecorder::measured(std::int64_t frame_index, const InertialSample& sample) noexcept {
  keep(frame_index, sample, &RecordingEntry::samples, inertia_);
}

void FlightRecorder::measured(std::int64_t frame_index, const OdometryPose& pose) noexcept {
  keep(frame_index, pose, &RecordingEntry::poses, wheels_);
}

template <typename Samples>
void FlightRecorder::keep(std::int64_t frame_index, const typename Samples::value_type& sample,
                          Samples RecordingEntry::*samples, RecordingEntry& waiting) noexcept {
  const auto count = static_cast<std::size_t>(waiting.number);
  if (count == (waiting.*samples).size() || waiting.index != frame_index) postMeasured(waiting);
  waiting.index = frame_index;
  (waiting.*samples)[static_cast<std::size_t>(waiting.number++)] = sample;
}

void FlightRecorder::appliedCorrection(std::int64_t message, std::int64_t number) noexcept {
  postNumbered(DecisionKind::correction, message, number);
}

void FlightRecorder::passedOver(std::int64_t index, std::int64_t time_ns) noexcept {
  RecordingEntry entry;
  entry.kind = DecisionKind::dropped;
  entry.index = index;
  entry.time_ns = time_ns;
  post(std::move(entry));
}

void FlightRecorder::processed(const std::shared_ptr<const FrameImages>& images, const CameraJpeg& jpeg) noexcept {
  RecordingEntry entry;
  const bool as_it_came = jpeg && static_cast<std::int64_t>(jpeg->size()) <= largest_image_;
  if (as_it_came) {
    entry.jpeg = jpeg;
  } else {
    entry.images = images;
  }
  entry.index = images->frame_index;
  entry.time_ns = images->time_ns;
  post(std::move(entry));
}

void FlightRecorder::unreadable(std::int64_t index, std::int64_t time_ns, const std::string& problem) noexcept {
  post(unreadableFrameEntry(index, time_ns, problem));
}

// The run posts nothing once `ended_` was seen, and stop() begins only when no post is under way: the recording has no
// gap at its end.
RecordingStatus FlightRecorder::stop() {
  ended_.store(true);
  while (posting_.load()) std::this_thread::yield();
  return thread_.stop();
}

// Before anything else is told.
void FlightRecorder::postMeasured(RecordingEntry& waiting) noexcept {
  if (waiting.number == 0) return;
  hand(waiting);
  waiting.number = 0;
}

void FlightRecorder::post(RecordingEntry entry) noexcept {
  postMeasured(inertia_);
  postMeasured(wheels_);
  hand(std::move(entry));
}

void FlightRecorder::hand(RecordingEntry entry) noexcept {
  posting_.store(true);
  if (!ended_.load()) thread_.post(std::move(entry));
  posting_.store(false);
}

void FlightRecorder::postNumbered(DecisionKind kind, std::int64_t index, std::int64_t number) noexcept {
  RecordingEntry entry;
  entry.kind = kind;
  entry.index = index;
  entry.number = number;
  post(std::move(entry));
}

}  // namespace edgeslam
