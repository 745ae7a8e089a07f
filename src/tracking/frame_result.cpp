#include "tracking/frame_result.h"

namespace edgeslam {

const char* stateName(TrackingState state) {
  switch (state) {
    case TrackingState::initialising:
      return "initialising";
    case TrackingState::tracking:
      return "tracking";
    case TrackingState::predicted:
      return "predicted";
    case TrackingState::recovered:
      return "recovered";
    case TrackingState::relocalised:
      return "relocalised";
    case TrackingState::lost:
      return "lost";
  }
  return "unknown";
}

Eigen::Matrix<float, 6, 1> standardDeviation(const FrameResult& result) {
  return result.world_covariance.diagonal().cwiseMax(0).cwiseSqrt().cast<float>();
}

void clear(FrameResult& result) {
  result.index = result.time_ns = 0;
  result.state = TrackingState::initialising;
  result.reason.clear();
  result.has_pose = false;
  result.position_is_held = false;
  result.world = -1;
  result.inertia.reset();
  result.wheels = {};
  result.world_T_camera = result.reference_T_camera = Pose();
  result.covariance.setZero();
  result.world_covariance.setZero();
  result.reference = -1;
  result.seen.points.clear();
  result.has_motion = result.previous_position_was_held = false;
  result.previous_time_ns = result.map_corrections = 0;
  result.previous_T_camera = Pose();
  result.tracked_points = result.mapped_points = 0;
  result.measured_noise = 0;
  result.noise_factor = 1;
  result.times = StageTimes();
  result.latency_ms = -1;
}

void reserve(std::size_t tracks, FrameResult& result) {
  result.reason.reserve(longest_reason);
  result.seen.points.reserve(tracks);
}

}  // namespace edgeslam
