// How the camera moved from frame to frame, as an odometry frame is made of (REP 105): only by what was measured
// between frames, or, over short gaps, predicted. Corrections of the map are no motion.
#pragma once

#include <cstdint>
#include <optional>

#include "tracking/frame_result.h"

namespace edgeslam {

constexpr double longest_bridged_s = 1;  // without a measured pose

// From one frame with a step to the next one.
struct MotionStep {
  std::int64_t from_ns = 0, to_ns = 0;     // the same at the first one
  Pose before_T_now;                       // map units
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update [translation; rotation] of that motion
  bool is_measured = false;                // or else predicted, or the position was held
  // Not known how far the camera moved in between, or lengths are in another unit from here on. The motion is none.
  bool is_broken = false;
};

class MotionSteps {
 public:
  // All frames, in order. None before the first measured pose, and where a gap is too long to be bridged.
  std::optional<MotionStep> next(const FrameResult& result);

 private:
  // The latest frame that had a step.
  struct Given {
    std::int64_t time_ns = 0;
    std::int64_t previous_time_ns = -1;  // of the frame that its motion is told from; -1: none
    Pose previous_T_camera;
    Matrix6d covariance = Matrix6d::Zero();
    bool is_measured = false;
  };

  bool isWithoutBridge(const FrameResult& result) const;
  std::optional<MotionStep> measured(const FrameResult& result) const;
  std::optional<MotionStep> predicted(const FrameResult& result) const;

  std::optional<Given> last_;
  std::int64_t known_ns_ = 0;  // the latest time of which the pose was measured, or held
  int world_ = 0;
  bool map_is_new_ = false;  // since the latest frame that had a step
};

}  // namespace edgeslam
