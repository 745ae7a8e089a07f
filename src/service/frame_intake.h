// What the camera gives on its way into the run: good frames, damaged ones, and why there are none.
#pragma once

#include <cstdint>

#include "drivers/frame_capture/reopening_camera.h"
#include "pipeline/live_run.h"
#include "service/capture_link.h"
#include "service/event_log.h"

namespace edgeslam {

// For the capture thread. Numbers and times go on over runs.
class FrameIntake {
 public:
  // All outlive it.
  FrameIntake(const ReopeningCamera& camera, CaptureLink& link, EventLog& log)
      : camera_(camera), link_(link), log_(log) {}

  // What came in the image of the run's next slot.
  void take(const Capture& captured, LiveRun& run);

 private:
  void takeFrame(const Capture& captured, LiveRun& run);
  void takeDamaged(const Capture& captured, LiveRun& run);
  FrameSlot& nextSlot(const CapturedFrame& frame, LiveRun& run);

  const ReopeningCamera& camera_;
  CaptureLink& link_;
  EventLog& log_;
  std::int64_t index_ = -1, time_ns_ = -1;  // of the last frame handed over
  bool damage_told_ = false;
};

}  // namespace edgeslam
