// Where the camera is by inertia, from the last frame that was located: how it turned, and, once the map's lie to the
// earth is known, how it moved.
#pragma once

#include <optional>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "inertia/inertial_alignment.h"
#include "inertia/inertial_history.h"
#include "map/keyframe.h"
#include "tracking/latest_frames.h"
#include "tracking/motion_model.h"

namespace edgeslam {

struct InertialPrediction {
  Pose world_T_camera;
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update [translation; rotation]
  bool knows_position = false;             // else it is the camera's own motion that goes on
};

// What a prediction says beside what is measured in a frame: nothing where the position is not known.
PosePrior priorOf(const InertialPrediction& prediction);

// How the camera turned.
struct InertialTurn {
  Eigen::Quaterniond first_R_second = Eigen::Quaterniond::Identity();
  double variance = 0;  // of a rotation vector, each axis [rad^2]
};

class InertialMotion {
 public:
  // Without a unit nothing is ever known.
  explicit InertialMotion(const std::optional<InertialUnit>& unit);

  void add(const InertialSample& sample);

  // Every frame that was located, after `last` where the map has it now; `sigma`: standard deviation of its place [map
  // units].
  void observe(const TimedCamera& last, const TimedCamera& camera, double sigma);
  // How the camera turned between two frames in a row, as it was seen; nothing where it is not finite.
  void observeTurn(const CameraTurn& turn);
  // Lengths are in another unit, or the place is another one, from now on.
  void forget() { located_.forget(); }

  // At `time_ns`, after `last`, whose covariance is given. `alignment`: of the world, where it is known; `by_camera`:
  // where the camera's own motion leads. None where nothing was measured.
  std::optional<InertialPrediction> predict(const TimedCamera& last, const Matrix6d& covariance, std::int64_t time_ns,
                                            const std::optional<InertialAlignment>& alignment,
                                            const InertialPrediction& by_camera) const;

  // By the gyroscope alone, from one time to another. None where nothing was measured.
  std::optional<InertialTurn> turnBetween(std::int64_t from_ns, std::int64_t to_ns,
                                          const std::optional<InertialAlignment>& alignment) const;

  // From the last keyframe in this world to a frame; where that becomes a keyframe, the next link is from there.
  InertialLink linkUpTo(std::int64_t time_ns, const std::optional<InertialAlignment>& alignment) const;
  InertialLink linkTo(KeyframeId keyframe, std::int64_t time_ns, const std::optional<InertialAlignment>& alignment);
  // A start begins with a frame, and has frames: the motion since its first one.
  void beginStart(KeyframeId first, std::int64_t time_ns);
  InertialLink linkSinceStart(std::int64_t time_ns);
  // The next link is from this one.
  void linkFrom(KeyframeId keyframe, std::int64_t time_ns);
  void forgetLink() { last_keyframe_ = -1; }
  // Gives a keyframe what came since the one before, and takes its memory.
  void tell(TrackedFrame& keyframe);

  // The clocks were found to differ by so much.
  void setOffset(std::int64_t offset_ns);
  // From now on nothing is known by inertia any more.
  void leaveOut() { is_left_out_ = true; }
  bool isThere() const { return history_ && !is_left_out_; }
  // The unit was found to be turned so against the camera.
  void setRotation(const Eigen::Quaterniond& imu_R_camera);

 private:
  struct Located {
    TimedCamera camera;
    double sigma = 0;
  };
  struct Speed {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // of the unit, world axes [m/s]
    double sigma = 0;                                    // standard deviation, each axis [m/s]
  };

  Eigen::Vector3d place(const Pose& world_T_camera, double metres_a_unit) const;
  std::optional<Speed> speedAt(const TimedCamera& last, const InertialAlignment& alignment) const;

  std::optional<InertialHistory> history_;
  bool is_left_out_ = false;
  Pose camera_T_imu_;
  LatestFrames<Located, 16> located_;
  KeyframeId last_keyframe_ = -1;
  std::int64_t keyframe_ns_ = 0;
  InertialLink since_start_;  // as far as it was asked for
  std::int64_t start_ns_ = 0;
  // Since the last keyframe was told.
  std::vector<InertialSample> felt_;
  std::vector<CameraTurn> turns_;
};

}  // namespace edgeslam
