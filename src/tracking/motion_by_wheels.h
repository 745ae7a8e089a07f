// Where the camera is by the wheels, from the last frame that was located, and whether they are believed: wheels slip,
// and turn in the air.
#pragma once

#include <optional>

#include "tracking/latest_frames.h"
#include "tracking/motion_model.h"
#include "wheels/odometry_history.h"
#include "wheels/wheel_motion.h"
#include "wheels/wheel_scale.h"

namespace edgeslam {

// From where the wheels carry the camera.
struct WheelDeparture {
  TimedCamera last;                        // a frame with a pose, ...
  OdometryPlace place;                     // ... where the wheels said that it was,
  OdometryPlace located;                   // and where the frame was that was located last ...
  Matrix6d covariance = Matrix6d::Zero();  // ... with this covariance
};

struct WheelPrediction {
  Pose world_T_camera;
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update [translation; rotation]
  bool knows_position = false;             // else it is the camera's own motion that goes on
  bool stood = false;                      // the wheels did not turn meanwhile
};

class MotionByWheels {
 public:
  // Without wheels nothing is ever known.
  explicit MotionByWheels(const std::optional<WheelOptions>& wheels);

  void add(const OdometryPose& pose);

  // At a time until which poses were added; of no piece where it is not known, or the wheels are not believed.
  OdometryPlace at(std::int64_t time_ns) const;

  // Every frame that was located, after `last` where the map has it now, with the covariance of its pose. Wheels that
  // contradict the camera for some frames are believed again once they agree with it for a while.
  void observe(const TimedCamera& last, const TimedCamera& camera, const Matrix6d& covariance, const WheelScale& scale);
  // What was located until now does not go together with what comes.
  void forget() { located_.forget(); }
  bool areBelieved() const { return are_believed_; }

  // At `time_ns`. `by_camera`: where the camera's own motion leads. None where the wheels do not tell it.
  std::optional<WheelPrediction> predict(const WheelDeparture& from, std::int64_t time_ns, const WheelScale& scale,
                                         const WheelPrediction& by_camera) const;

 private:
  struct Located {
    TimedCamera camera;
    Matrix6d covariance = Matrix6d::Zero();
    OdometryPlace place;
  };

  std::optional<OdometryPlace> measuredAt(std::int64_t time_ns) const;
  bool contradicts(const Located& before, const Located& now, const WheelScale& scale) const;

  std::optional<WheelOptions> wheels_;
  std::optional<OdometryHistory> history_;
  LatestFrames<Located, 64> located_;
  bool are_believed_ = true;
  int contradictions_ = 0, agreements_ = 0;  // in a row
  std::int64_t times_doubted_ = 0;
};

}  // namespace edgeslam
