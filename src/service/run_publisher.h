// What a live run gives out, as LCM messages and to the viewer: each frame, the status each second, the map; and the
// commands of the robot and of the person who looks on.
// The daemon and a replay at real time publish by the same one.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "drivers/lcm/lcm_publisher.h"
#include "drivers/viewer/viewer.h"
#include "pipeline/live_run.h"
#include "recording/flight_recorder.h"
#include "scale/scale_from_distance.h"
#include "scale/scale_search.h"
#include "service/background_work.h"
#include "service/capture_link.h"
#include "service/event_log.h"
#include "service/service_notification.h"

namespace edgeslam {

struct PublishingSetup {
  LcmOptions lcm;
  double map_interval_s = 5;  // SLAM_MAP at most so often where the map changed; 0: on request only
  Pose body_T_camera;         // translation [m]
  Camera camera;
  ScaleOptions scale;
  std::string map_file;      // empty: no command saves the map
  Viewer* viewer = nullptr;  // null: nobody can look on; must outlive the publisher
  bool begins_anew = false;  // capture carries out commands that begin another run: reset, start of a recording
};

// With all that the configuration says of it.
PublishingSetup publishingSetup(const Configuration& configuration, const Camera& camera);

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

  // Since the start, over all runs; for the thread that starts and ends them.
  PublisherStatus status() const;
  // Of the service; for the thread that starts and ends runs, likewise.
  ServiceNotification& service() { return service_; }

 private:
  using Clock = std::chrono::steady_clock;
  using MapPointer = std::shared_ptr<const Map>;
  struct MapSaveWish {
    std::optional<Command> command;  // none: a signal
  };

  // run_publisher.cpp: frames and status.
  void eachSecond(Clock::time_point now);
  void showStatus(const PublisherStatus& status);
  void tellChanges(const PublisherStatus& status);
  LiveCounts countsOverRuns() const;
  bool isRecording() const;
  bool recordsWithGaps() const;

  // run_publisher_commands.cpp: commands and map.
  void carryOut(const Command& command);
  void askToSaveMap(const MapSaveWish& wish);
  void stopRecording(const Command& command);
  void endRecording(const std::optional<Command>& command);
  void passToCapture(const Command& command);
  void answer(const Command& command, bool accepted, const std::string& message);
  void publishChangedMap(Clock::time_point now);
  void showChangedMap(Clock::time_point now);
  void mapCame(const MapPointer& map);
  void saveMapInBackground(const MapPointer& map);
  void answerSaves(const std::vector<MapSaveWish>& wishes, bool saved, const std::string& message);

  // run_publisher_scale.cpp.
  void forgetScale();
  void mapWasCorrected();
  void setScale(const Command& command);
  void takeOdometry();
  void followScale(Clock::time_point now);
  void lookForGround(const MapPointer& map);
  std::string scaleProblem() const;
  void tellScaleProblem();

  PublishingSetup setup_;
  CaptureLink& link_;
  EventLog& log_;
  ServiceNotification service_;
  LcmPublisher publisher_;
  PositionHistory history_;
  ScaleSearch search_;
  BackgroundWork work_;
  BackgroundWork disk_work_;  // may take as long as a disk that is slow, or does not answer
  LiveRun* run_ = nullptr;
  std::shared_ptr<FlightRecorder> recorder_;
  ScaleKind scale_ = ScaleKind::unknown;

  const Clock::time_point start_ = Clock::now();
  Clock::time_point next_second_ = start_;
  LiveCounts earlier_runs_;
  std::int64_t unreadable_ = 0, waits_ = 0;
  int recoveries_ = 0, relocalisations_ = 0, loops_ = 0;
  TrackingState state_ = TrackingState::initialising;
  std::string reason_;

  // What the log was told last.
  std::string told_state_, told_lcm_problem_;
  bool told_recording_ = false, told_gaps_ = false;

  bool ground_wanted_ = false;                 // of the map that was asked for
  KeyframeId ground_keyframe_ = -1;            // the latest of the map in which it was looked for
  std::int64_t ground_looks_void_ = 0;         // counts what makes looks under way worthless
  std::set<std::string> told_scale_problems_;  // without their numbers

  bool map_wanted_ = false;  // for SLAM_MAP
  std::vector<MapSaveWish> save_wishes_;
  Clock::time_point next_map_{};
  std::int64_t published_changes_ = 0, map_version_ = 0;
  Clock::time_point next_shown_map_{};
  std::int64_t shown_changes_ = -1;  // of the map that the viewer has; -1: it has none
};

}  // namespace edgeslam
