#include "service/frame_intake.h"

#include <algorithm>
#include <utility>

namespace edgeslam {

void FrameIntake::take(const Capture& captured, LiveRun& run) {
  switch (captured.event) {
    case CaptureEvent::frame:
      return takeFrame(captured, run);
    case CaptureEvent::damaged_frame:
      return takeDamaged(captured, run);
    case CaptureEvent::interrupted:
      log_.tell(captured.message);
      return link_.setCameraProblem(captured.message);
    case CaptureEvent::none_yet:
      if (!camera_.isOpen() || camera_.stream().is_recording) link_.waited();
      return;
    case CaptureEvent::ended:
      return;
  }
}

void FrameIntake::takeFrame(const Capture& captured, LiveRun& run) {
  const CapturedFrame& frame = captured.frame;
  if (frame.after_interruption) {
    log_.tell(camera_.stream().camera + ": gives frames, " + camera_.stream().format);
    link_.setCameraProblem("");
    damage_told_ = false;
  }
  FrameSlot& slot = nextSlot(frame, run);
  slot.problem.clear();
  slot.jpeg = captured.jpeg;
  run.handOver();
  link_.lost(frame.lost_before + frame.passed_over_before);
}

// A frame that came and cannot be used; one without a time stamp of its own is only counted.
void FrameIntake::takeDamaged(const Capture& captured, LiveRun& run) {
  const CapturedFrame& frame = captured.frame;
  if (!std::exchange(damage_told_, true)) log_.tell(captured.message + " (more of them are only counted)");
  if (frame.time_ns <= time_ns_) return link_.lost(1);
  nextSlot(frame, run).problem = captured.message;
  run.handOver();
  link_.lost(frame.lost_before + frame.passed_over_before);
}

FrameSlot& FrameIntake::nextSlot(const CapturedFrame& frame, LiveRun& run) {
  FrameSlot& slot = run.nextSlot();
  slot.index = index_ = std::max(index_ + 1, frame.sequence);
  slot.time_ns = time_ns_ = frame.time_ns;
  return slot;
}

}  // namespace edgeslam
