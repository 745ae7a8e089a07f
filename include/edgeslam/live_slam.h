// SLAM as a robot runs it, as a library: tracking and mapping in threads of their own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "edgeslam/input_error.h"
#include "edgeslam/types.h"

namespace edgeslam {

// Counted since the start.
struct LiveCounters {
  std::int64_t handed_over = 0;
  std::int64_t processed = 0;
  std::int64_t passed_over = 0;  // a newer frame was there first
  std::size_t keyframes = 0;     // of the map now, in all worlds
  std::size_t points = 0;
};

class EDGESLAM_PUBLIC LiveSlam {
 public:
  // Called for each frame that was processed, in order, by one thread of the library's. Must not throw, nor call this
  // object; what takes long delays later frames' calls, not their tracking.
  using PoseReceiver = std::function<void(const PosedFrame&)>;
  // Called by the same thread, with a line for each recovery, relocalisation and loop.
  using EventReceiver = std::function<void(const std::string&)>;

  // A configuration as the program's, with a camera's calibration in it; its sections capture, lcm, recording and scale
  // are not used, and of the section map just `frozen`. Throws InputError where it cannot be used.
  LiveSlam(const std::string& configuration_file, PoseReceiver poses, EventReceiver events = {});
  // Continues a map that was saved with the same calibration; with `map.frozen`, which needs one, it is only localised
  // in, and stays as it is. Throws InputError.
  LiveSlam(const std::string& configuration_file, const std::string& map_file, PoseReceiver poses,
           EventReceiver events = {});
  // Stops at once.
  ~LiveSlam();
  LiveSlam(const LiveSlam&) = delete;
  LiveSlam& operator=(const LiveSlam&) = delete;

  int width() const;  // of the frames [px]
  int height() const;
  // What could not be set up (priorities, memory), a line each; it runs on without.
  std::vector<std::string> problems() const;

  // From one thread. Copies the image and never waits: where tracking has not taken the frame before, this one takes
  // its place. Throws InputError where its size is not the calibration's or its time stamp not after the last one's.
  void handOver(const GreyImage& image, std::int64_t time_ns);
  // What the inertial unit measured, in order, as it comes; from one thread, which may be another. Never waits. Of use
  // where the configuration has `imu.enabled`. Throws InputError where no unit can have measured it.
  void add(const InertialMeasurement& measurement);
  // Where the wheels say that the robot is, likewise. Of use where the configuration has `wheels.enabled`.
  void add(const WheelMeasurement& measurement);
  LiveCounters counters() const;

  // No frame follows. Waits until mapping has come to its end.
  void stop();
  // After stop(). Of all worlds.
  std::vector<MapEdgePoint> map() const;
  // After stop(). Whole or not at all. Throws InputError where it cannot be written, or there is no map.
  void saveMap(const std::string& map_file) const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace edgeslam
