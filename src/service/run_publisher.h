// What a live run gives out, as LCM messages, to ROS 2 and to the viewer: each frame, the status each second, the map;
// and the commands of the robot and of the person who looks on. The daemon and a replay at real time publish by the
// same one.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "drivers/lcm/lcm_publisher.h"
#include "drivers/ros2/ros2_publisher.h"
#include "pipeline/live_run.h"
#include "recording/flight_recorder.h"
#include "service/background_work.h"
#include "service/capture_link.h"
#include "service/command_answers.h"
#include "service/event_log.h"
#include "service/map_publisher.h"
#include "service/map_saving.h"
#include "service/metric_scale.h"
#include "service/publishing_setup.h"
#include "service/run_commands.h"
#include "service/run_log.h"
#include "service/run_recording.h"
#include "service/run_totals.h"
#include "service/service_notification.h"
#include "service/world_watch.h"

namespace edgeslam {

enum class RunStart { new_map, saved_map, same_map };

// All functions are for the run's publishing thread, begin() and end() for the one that starts and ends the run, while
// there is no publishing thread.
class RunPublisher {
 public:
  // Throws InputError where LCM's options cannot be.
  RunPublisher(const PublishingSetup& setup, CaptureLink& link, EventLog& log);

  // Before LiveRun::start(). `recorder` may be null. same_map: the scale stays.
  void begin(LiveRun& run, std::shared_ptr<FlightRecorder> recorder, RunStart start);
  // After LiveRun::stop(). Ends the recording; a last status has the run's totals. What waits for the disk, the
  // recording's end and saves of the map, goes on beside the next run; after the last one it is waited for.
  void end(bool is_last);

  // LiveObserver's.
  LiveObserver observer();
  void frame(const FrameResult& result, const std::string& problem);
  void report(const MappingReport& report);
  void tick();

  // The robot's inertial unit and its wheels, where they are listened to, else null; for capture's thread.
  ImuReceiver* imu() { return publisher_.imu(); }
  OdometryReceiver* wheels() { return publisher_.wheels(); }

  // Since the start, over all runs; for the thread that starts and ends them.
  PublisherStatus status() const;
  // Of the service; for the thread that starts and ends runs, likewise.
  ServiceNotification& service() { return service_; }

 private:
  using Clock = std::chrono::steady_clock;

  void carryOutCommands();
  void eachSecond(Clock::time_point now);
  void giveOut(const PublisherStatus& status);
  void tellChanges(const PublisherStatus& status);

  Viewer* const viewer_;  // null: nobody can look on
  CaptureLink& link_;
  ServiceNotification service_;
  LcmPublisher publisher_;
  const std::unique_ptr<Ros2Publisher> ros2_;  // null: not wanted
  CommandAnswers answers_;
  BackgroundWork work_;
  BackgroundWork disk_work_;  // may take as long as a disk that is slow, or does not answer

  MetricScale scale_;
  MapPublisher map_;
  MapSaving saving_;
  RunRecording recording_;
  RunCommands commands_;
  RunTotals totals_;
  WorldWatch worlds_;
  RunLog log_;

  LiveRun* run_ = nullptr;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point next_second_ = start_;
  std::int64_t waits_ = 0;                             // of capture, that the watchdog was fed for
  TrackingState state_ = TrackingState::initialising;  // of the last frame, and why
  std::string reason_;
};

}  // namespace edgeslam
