// The flight recorder of a live run: hands the run's frames and decisions to the thread that writes them.
#pragma once

#include <atomic>
#include <string>

#include "pipeline/decision_sink.h"
#include "pipeline/settings.h"
#include "recording/recording_thread.h"

namespace edgeslam {

RecordingLimits recordingLimits(const RecordingSpace& space);

class FlightRecorder : public DecisionSink {
 public:
  // Throws InputError where the recording cannot be begun.
  FlightRecorder(const std::string& folder, const RecordingDescription& description,
                 const RecordingLimits& limits = {});

  void mappingBusy(std::int64_t frame_index) noexcept override;
  void tookUpdate(std::int64_t frame_index, std::int64_t number) noexcept override;
  void measured(std::int64_t frame_index, const InertialSample& sample) noexcept override;
  void measured(std::int64_t frame_index, const OdometryPose& pose) noexcept override;
  void appliedCorrection(std::int64_t message, std::int64_t number) noexcept override;
  void passedOver(std::int64_t index, std::int64_t time_ns) noexcept override;
  void processed(const std::shared_ptr<const FrameImages>& images, const CameraJpeg& jpeg) noexcept override;
  void unreadable(std::int64_t index, std::int64_t time_ns, const std::string& problem) noexcept override;

  // Ends the recording, from any one thread, also while the run goes on: what it decides later is not recorded. Takes
  // up to 3 s, or as long as the disk needs for a write.
  RecordingStatus stop();

  RecordingStatus status() const { return thread_.status(); }
  const std::string& folder() const { return folder_; }

 private:
  void post(RecordingEntry entry) noexcept;
  void postMeasured(RecordingEntry& waiting) noexcept;
  template <typename Samples>
  void keep(std::int64_t frame_index, const typename Samples::value_type& sample, Samples RecordingEntry::*samples,
            RecordingEntry& waiting) noexcept;
  void hand(RecordingEntry entry) noexcept;
  void postNumbered(DecisionKind kind, std::int64_t index, std::int64_t number) noexcept;

  const std::string folder_;
  const std::int64_t largest_image_;  // [bytes]
  RecordingEntry inertia_, wheels_;   // what waits to go together
  std::atomic<bool> ended_{false}, posting_{false};
  RecordingThread thread_;
};

}  // namespace edgeslam
