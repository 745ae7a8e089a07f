// Who writes down what a live run decided by the clock (the flight recorder). Called by tracking's thread between a
// frame's pose and the next frame: it must not wait, lock or allocate.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "image_formats/jpeg_decoder.h"
#include "inertia/inertial_unit.h"
#include "map/keyframe.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

class DecisionSink {
 public:
  virtual ~DecisionSink() = default;
  // Before frame `frame_index` was processed, tracking took map update `number`.
  virtual void tookUpdate(std::int64_t frame_index, std::int64_t number) noexcept = 0;
  // Before frame `frame_index` was processed, tracking was given what the inertial unit measured.
  virtual void measured(std::int64_t frame_index, const InertialSample& sample) noexcept = 0;
  // Likewise, where the wheels say that the robot was.
  virtual void measured(std::int64_t frame_index, const OdometryPose& pose) noexcept = 0;
  // Frame `frame_index` tells mapping nothing, mapping being far behind.
  virtual void mappingBusy(std::int64_t frame_index) noexcept = 0;
  // Before message `message` was handled, mapping applied correction `number`.
  virtual void appliedCorrection(std::int64_t message, std::int64_t number) noexcept = 0;
  virtual void passedOver(std::int64_t index, std::int64_t time_ns) noexcept = 0;
  // `jpeg`: as the camera sent the frame, where that is kept; otherwise null.
  virtual void processed(const std::shared_ptr<const FrameImages>& images, const CameraJpeg& jpeg) noexcept = 0;
  virtual void unreadable(std::int64_t index, std::int64_t time_ns, const std::string& problem) noexcept = 0;
};

}  // namespace edgeslam
