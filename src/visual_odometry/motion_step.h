// How the camera moved from frame to frame, as an odometry frame is made of (REP 105): only by what was measured
// between frames, or, over short gaps, predicted. Corrections of the map are no motion.
#pragma once

#include <cstdint>
#include <optional>

#include "tracking/frame_result.h"

namespace edgeslam {

constexpr double longest_bridged_s = 1;  // without a measured pose
constexpr double taken_back_over_s = 0.5;

// From one frame with a step to the next one.
struct MotionStep {
  std::int64_t from_ns = 0, to_ns = 0;  // the same at the first one
  // As it was seen to move or, where it was not seen, predicted [map units]; and what of earlier predictions is taken
  // back with this step, since they were not quite right: a little at a time, so that nothing jumps.
  Pose before_T_now, taken_back;
  // Of right-hand updates [translation; rotation]. The errors of two frames' poses have most in common, as both are of
  // one map: what the motion adds for good is what the pose in the world became less certain by.
  Matrix6d drift = Matrix6d::Zero();            // that this step adds
  Matrix6d pose_covariance = Matrix6d::Zero();  // of the pose now, in the map as it is, or as it was predicted
  bool is_measured = false;                     // or else predicted, or the position was held
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
  // The latest frame of which all was measured.
  struct Known {
    int world = 0;
    std::int64_t map_corrections = 0;
    Pose world_T_camera;
    Matrix6d world_covariance = Matrix6d::Zero();
    Pose known_T_given;  // as the steps since then add up
    Pose error;          // that was pending then
  };
  // What was predicted wrong and is not taken back yet: now_T_truth.
  struct Pending {
    Pose error;
    Matrix6d covariance = Matrix6d::Zero();
    double seconds = 0;  // that are left for it
  };

  bool isBroken(const FrameResult& result) const;
  std::optional<Pose> measuredMotion(const FrameResult& result) const;
  std::optional<Pose> predictedMotion(const FrameResult& result) const;
  bool findError(const FrameResult& result, const MotionStep& step);
  void takeBack(MotionStep& step);
  Matrix6d driftSinceKnown(const FrameResult& result, const MotionStep& step) const;
  void remember(const FrameResult& result, const MotionStep& step);

  std::optional<Given> last_;
  Known known_;
  Pending pending_;
  std::int64_t seen_ns_ = 0;  // the latest time of which the pose was measured, or its position held
  bool map_is_new_ = false;   // since the latest frame that had a step
};

}  // namespace edgeslam
