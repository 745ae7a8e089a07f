// What the robot's inertial unit gives on its way into the run, and what is told of it.
#pragma once

#include "drivers/frame_capture/reopening_camera.h"
#include "drivers/lcm/imu_message.h"
#include "inertia/inertial_watch.h"
#include "pipeline/live_run.h"
#include "service/capture_link.h"
#include "service/event_log.h"

namespace edgeslam {

// For the capture thread.
class InertiaIntake {
 public:
  // All outlive it. `offset_ns`: of the unit's clock from the camera's.
  InertiaIntake(ImuReceiver& receiver, std::int64_t offset_ns, CaptureLink& link, EventLog& log);

  // Before a frame goes into the run: all that has come. Never waits.
  void take(const Capture& captured, LiveRun& run);

 private:
  void tell();

  ImuReceiver& receiver_;
  CaptureLink& link_;
  EventLog& log_;
  InertialWatch watch_;
  std::int64_t told_ns_ = 0;  // the frame at which it was last looked at what is wrong
  std::string told_;
};

}  // namespace edgeslam
