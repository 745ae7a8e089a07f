// The service on the robot: camera to live run to LCM, until a signal ends it. Runs that are begun anew (reset, start
// of a recording) follow each other in the same process, camera and LCM staying open.
#pragma once

#include <memory>
#include <optional>

#include "drivers/frame_capture/reopening_camera.h"
#include "drivers/lcm/imu_message.h"
#include "drivers/lcm/odometry.h"
#include "inertia/inertial_watch.h"
#include "service/capture_link.h"
#include "service/daemon_page.h"
#include "service/daemon_setup.h"
#include "service/daemon_signals.h"
#include "service/end_deadline.h"
#include "service/event_log.h"
#include "service/frame_intake.h"
#include "service/memory_reserve.h"
#include "service/next_recording.h"
#include "service/run_publisher.h"
#include "service/sensor_intake.h"
#include "wheels/wheel_watch.h"

namespace edgeslam {

class Daemon {
 public:
  // Tells what can go wrong, opens the camera (or waits for it later) and LCM. Throws InputError for what waiting does
  // not heal.
  Daemon(DaemonSetup setup, EventLog& log);

  // Until SIGTERM, SIGINT or the end of a recording as a camera. Throws InputError where the map cannot be written at
  // the end, and std::bad_alloc where memory ran out: the map is written then, if it can be.
  void run();

 private:
  // Why a run ended: the end of all, or a command that begins another one.
  struct RunEnd {
    std::optional<Command> command;
    bool settles = false;  // the frames are at their end: mapping finishes
  };

  void openCamera();
  void openSensors();
  void tellUnheard(const char* what);
  void takeSensors(const Capture& captured, LiveRun& run);
  void beginRecording();
  void oneRun();
  void tellProcessorProblems(const LiveRun& run);
  void tellReadout();
  RunEnd capture(LiveRun& run);
  void beginNext(const Command& command, LiveRun& run);
  void finish(const Map& map);
  void writeMap(const Map& map);

  DaemonSignals signals_;  // first: threads inherit what is blocked
  DaemonSetup setup_;
  EventLog& log_;
  MemoryReserve reserve_;
  EndDeadline deadline_;  // before all that may wait for the disk
  CaptureLink link_;
  std::unique_ptr<ReopeningCamera> camera_;
  std::unique_ptr<DaemonPage> page_;
  std::unique_ptr<RunPublisher> publisher_;
  std::unique_ptr<FrameIntake> intake_;
  std::optional<SensorIntake<ImuReceiver, InertialWatch>> inertia_;  // none: there is no unit
  std::optional<SensorIntake<OdometryReceiver, WheelWatch>> wheels_;

  RunStart start_ = RunStart::new_map;
  std::optional<Map> map_;  // that the run to come continues
  bool ended_ = false;
  bool processors_told_ = false;
  bool readout_told_ = false;

  NextRecording next_recording_;  // last: the others outlive what it does in the background
};

}  // namespace edgeslam
