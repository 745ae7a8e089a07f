// The map on its way out: as SLAM_MAP and SLAM_MAP_LINES, and to ROS 2, on request and where it changed; and to the
// viewer while someone looks on.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "drivers/lcm/lcm_publisher.h"
#include "drivers/ros2/ros2_publisher.h"
#include "drivers/viewer/viewer.h"
#include "geometry/camera.h"
#include "pipeline/live_run.h"
#include "service/background_work.h"

namespace edgeslam {

// For the publishing thread.
class MapPublisher {
 public:
  using Clock = std::chrono::steady_clock;

  // `interval_s`: the map is sent at most so often where it changed; 0: on request only. `ros2` and `viewer` may be
  // null. What is referred to outlives it; work that was begun may outlive this object.
  MapPublisher(const Camera& camera, double interval_s, LcmPublisher& publisher, Ros2Publisher* ros2, Viewer* viewer,
               BackgroundWork& work);

  void begin(LiveRun& run);
  void end() { is_wanted_ = false; }

  // Points, lines and keyframes that go out are those of this world; -1: no pose yet, of the one with most keyframes.
  void enterWorld(int world);
  // SLAM_MAP and SLAM_MAP_LINES follow as soon as the map is there.
  void ask();
  void everySecond(Clock::time_point now);
  // One that the run was asked for, by whomever.
  void mapCame(const std::shared_ptr<const Map>& map);

 private:
  void publishWhereChanged(Clock::time_point now);
  void showWhereChanged(Clock::time_point now);

  const Camera camera_;
  const double interval_s_;
  LcmPublisher& publisher_;
  Ros2Publisher* ros2_;
  Viewer* viewer_;
  BackgroundWork& work_;
  LiveRun* run_ = nullptr;  // from begin() on

  int world_ = -1;
  bool is_wanted_ = false;  // over LCM
  Clock::time_point next_time_{};
  std::int64_t published_changes_ = 0, version_ = 0;
  Clock::time_point next_shown_time_{};
  std::int64_t shown_changes_ = -1;  // of the map that the viewer has; -1: it has none
};

// The points and lines of one world.
PublishedMap publishedMap(const Map& map, int world, const Camera& camera);

// The world of a map with most keyframes, of several the earliest; 0 for an empty map.
int largestWorld(const Map& map);

}  // namespace edgeslam
