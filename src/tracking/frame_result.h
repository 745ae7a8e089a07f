// What a frame came to, as it is given out at the time: its state, its pose and how well that is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "inertia/inertial_alignment.h"
#include "map/keyframe.h"
#include "tracking/seen_points.h"
#include "tracking/stage_times.h"
#include "wheels/wheel_scale.h"

namespace edgeslam {

constexpr std::size_t longest_reason = 256;  // texts up to this take no memory anew [byte]

enum class TrackingState {
  initialising,  // no map yet; the reason says what is waited for
  tracking,      // a measured pose
  predicted,     // a pose from motion alone (blurred or unreadable frame): not good, not in trajectory.txt
  recovered,     // a measured pose again after a track loss (P21)
  relocalised,   // a measured pose again, found in the whole map (P22)
  lost           // no pose
};

// "initialising", "tracking", ...
const char* stateName(TrackingState state);

// True where the pose was measured, not guessed.
inline bool isGoodPose(TrackingState state) {
  return state == TrackingState::tracking || state == TrackingState::recovered || state == TrackingState::relocalised;
}

struct FrameResult {
  std::int64_t index = 0;  // in the source
  std::int64_t time_ns = 0;
  TrackingState state = TrackingState::initialising;
  std::string reason;  // why it is not plainly `tracking`, or empty
  bool has_pose = false;
  bool position_is_held = false;  // only the rotation is measured (orientation_only.h)
  int world = -1;                 // that the pose is in: counted from 0, one more where a new map was begun; -1: none
  std::optional<InertialAlignment> inertia;  // how that world lies to the earth, where there is an inertial unit
  WheelScale wheels;                         // how many metres its unit is, where there are wheels
  Pose world_T_camera;                       // map units; measured, or from motion alone where the state says so
  // Of the right-hand update [translation; rotation]: of the pose in the map as it is, and of the pose in the world, in
  // which the map itself may have drifted since its first keyframe.
  Matrix6d covariance = Matrix6d::Zero(), world_covariance = Matrix6d::Zero();
  KeyframeId reference = -1;  // the keyframe that carries this frame's final pose, or -1
  Pose reference_T_camera;
  SeenPoints seen;  // what the pose was measured by, for the final one; none in a frozen map, which stays as it is
  // How the camera moved since the frame that was located before, both as the map is now, so that corrections of the
  // map are no motion. Predicted where the pose is, and where it was lost.
  bool has_motion = false;
  std::int64_t previous_time_ns = 0;
  Pose previous_T_camera;
  bool previous_position_was_held = false;
  std::int64_t map_corrections = 0;  // of the map as a whole (loops, worlds joined), until this frame
  int tracked_points = 0;            // points followed in the image
  int mapped_points = 0;             // map points that agree with the pose
  // How many times as far as presumed of a good camera the map points in view erred, in this frame alone; 0: too few.
  double measured_noise = 0;
  double noise_factor = 1;  // how many times as far as presumed of a good camera measurements err (measured_noise.h)
  StageTimes times;
  double latency_ms = -1;  // of a live run: from the frame's handing over by capture to its pose; negative: not known
};

// Standard deviations of the pose in the world: right-hand update [translation; rotation] (map units, rad); 0 where
// nothing is known of them.
Eigen::Matrix<float, 6, 1> standardDeviation(const FrameResult& result);

// As made anew, but with its memory.
void clear(FrameResult& result);

// Gives it the memory that it needs for so many tracks.
void reserve(std::size_t tracks, FrameResult& result);

}  // namespace edgeslam
