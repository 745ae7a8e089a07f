// SLAM as a library: frames in, poses and a map out, in the caller's thread.
//
//     edgeslam::Slam slam("robot.yaml");
//     const edgeslam::PosedFrame frame = slam.process({pixels, 640, 480, 640}, time_ns);
//     if (frame.isGood()) steerBy(frame.pose);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "edgeslam/input_error.h"
#include "edgeslam/types.h"

namespace edgeslam {

// Mapping is done between the frames: the same frames give the same poses and the same map to the last bit, but a frame
// that makes a keyframe takes longer. LiveSlam is for robots: a Slam keeps a few hundred bytes of every frame for
// finish(). An object is for one thread at a time; different objects are independent of each other.
class EDGESLAM_PUBLIC Slam {
 public:
  // A configuration as the program's, with a camera's calibration in it. Throws InputError where it cannot be used.
  explicit Slam(const std::string& configuration_file);
  // Throws InputError.
  Slam(const std::string& calibration_file, const std::string& configuration_file);
  ~Slam();
  Slam(Slam&&) noexcept;
  Slam& operator=(Slam&&) noexcept;

  int width() const;  // of the frames [px]
  int height() const;

  // Before the first frame: continues a map that was saved with the same calibration. With `map.frozen` in the
  // configuration, which needs a map, it is only localised in, and stays as it is. Throws InputError.
  void goOnWith(const std::string& map_file);

  // What the inertial unit measured, in order: before each frame what was measured until then, and best the first
  // after it. Of use where the configuration has `imu.enabled`. One that is not after the last is left out. Throws
  // InputError where no unit can have measured it.
  void add(const InertialMeasurement& measurement);

  // Where the wheels say that the robot is, likewise. Of use where the configuration has `wheels.enabled`.
  void add(const WheelMeasurement& measurement);

  // The next frame. Throws InputError where its size is not the calibration's or its time stamp not after the last
  // one's, or a frozen map was not given; nothing is changed then. `index` counts frames.
  PosedFrame process(const GreyImage& image, std::int64_t time_ns);
  // A frame that could not be had; the pose, if any, is predicted.
  PosedFrame skip(std::int64_t time_ns, const std::string& problem);

  // What happened to the map since this was last asked: recoveries, relocalisations, loops, a line each.
  std::vector<std::string> takeEvents();
  // As of now, of all worlds.
  std::vector<MapEdgePoint> map() const;
  std::vector<TimedCameraPose> keyframes() const;
  // Whole or not at all. Throws InputError where it cannot be written, or there is no map yet.
  void saveMap(const std::string& map_file) const;

  // After the last frame: loops are closed, and every frame with a good pose gets its final one. No frame can follow.
  std::vector<TimedCameraPose> finish();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace edgeslam
