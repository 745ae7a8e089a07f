// The body in a frame that never jumps (`odom` of REP 105), and where that frame is in `local`, as messages.
#pragma once

#include <optional>

#include "drivers/lcm/body_pose.h"
#include "edgeslam/correction_t.hpp"
#include "edgeslam/pose_t.hpp"
#include "visual_odometry/odometry_frame.h"

namespace edgeslam {

struct OdometryMessages {
  pose_t odometry;
  correction_t correction;
};

class BodyOdometry {
 public:
  // All frames, in order. None where the body's motion to a frame is not known, nor for how long.
  std::optional<OdometryMessages> next(const FrameResult& result, const RobotSetup& robot);

 private:
  // What tells why the correction changed.
  struct Circumstances {
    int world = 0;
    std::int64_t map_corrections = 0;
    double metres_per_unit = 1;
    bool is_scale_known = false;
    std::optional<Eigen::Vector3d> down{};
    bool is_measured = false;
    bool is_taking_back = false;  // what was predicted wrong
  };

  std::int8_t reasonOf(const FrameResult& result, const Circumstances& now) const;
  void correct(const FrameResult& result, const RobotSetup& robot, const Circumstances& now);

  MotionSteps steps_;
  OdometryFrame frame_;
  std::optional<Circumstances> before_;  // at the latest frame that had a step
  Pose local_T_odom_;
  std::int64_t change_utime_ = 0;
  std::int8_t change_ = correction_t::START;
};

}  // namespace edgeslam
