// The metric scale from wheel odometry: the body's way between two frames in metres, over its way in map units. Ways
// are of the BODY: the camera may sit anywhere on the robot, and its way where the robot turns is another one.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "geometry/scale_estimate.h"
#include "scale/measured_pose.h"
#include "scale/scale_options.h"
#include "wheels/odometry_history.h"

namespace edgeslam {

struct MotionComparison {
  ScaleMeasurement measurement;  // where there is no problem
  std::string problem;           // why the two motions tell no scale
};

// Of one stretch. `before_T_now`: the body's, by the wheels [m]. The camera's motion s * t (map units times the scale)
// is what the wheels say less what the turn does to the camera's place on the body.
MotionComparison compareMotions(const Pose& before_T_now, const MeasuredPose& before, const MeasuredPose& now,
                                const Pose& body_T_camera, const OdometryOptions& options);

class ScaleFromOdometry {
 public:
  // `body_T_camera`: translation [m].
  ScaleFromOdometry(const OdometryOptions& options, const Pose& body_T_camera);

  // Both as they come. Frames wait for the odometry around them.
  void add(const OdometryPose& pose);
  void add(const MeasuredPose& frame);
  // Poses before and after do not go together: the map was corrected, or tracking lost it in between.
  void breakOff();
  // Another map.
  void clear();
  // Once a second or so, for what is told of odometry that stops.
  void secondPassed();

  // None while there are too few stretches.
  std::optional<ScaleEstimate> estimate() const;
  // What is amiss or still waited for, in words; or empty.
  std::string problem() const;

  static constexpr std::size_t fewest_stretches = 6;

 private:
  struct Paired {
    MeasuredPose frame;
    OdometryPlace body;
  };

  void pair();
  void advance(const Paired& paired);
  void lookAtClock(std::int64_t frame_utime);

  OdometryOptions options_;
  Pose body_T_camera_;
  OdometryHistory history_;
  std::deque<MeasuredPose> waiting_;
  std::optional<Paired> start_, last_;  // of the stretch under way
  std::deque<ScaleMeasurement> stretches_;
  std::string refused_;  // why the last stretches told no scale
  int refused_in_a_row_ = 0;
  int silent_s_ = 1;
  int frames_of_another_clock_ = 0;
  double clock_ahead_s_ = 0;  // of the odometry before the camera
};

}  // namespace edgeslam
