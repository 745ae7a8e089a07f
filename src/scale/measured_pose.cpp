#include "scale/measured_pose.h"

#include <algorithm>

namespace edgeslam {

bool hasUsablePose(const FrameResult& result) {
  const Pose& pose = result.world_T_camera;
  return result.has_pose && pose.translation.allFinite() && pose.rotation.coeffs().allFinite() &&
         pose.rotation.norm() > 1e-3;
}

// A pose whose world is not told is in the first.
int worldOf(const FrameResult& result) { return hasUsablePose(result) ? std::max(0, result.world) : -1; }

std::optional<MeasuredPose> measuredPose(const FrameResult& result) {
  if (!isGoodPose(result.state) || result.position_is_held || !hasUsablePose(result)) return std::nullopt;
  MeasuredPose measured;
  measured.time_ns = result.time_ns;
  measured.world = worldOf(result);
  measured.world_T_camera = {result.world_T_camera.rotation.normalized(), result.world_T_camera.translation};
  measured.covariance_camera = result.covariance;
  const Pose& hanging = result.reference_T_camera;
  if (hanging.translation.allFinite() && hanging.rotation.coeffs().allFinite() && hanging.rotation.norm() > 1e-3) {
    measured.reference = result.reference;
    measured.reference_T_camera = {hanging.rotation.normalized(), hanging.translation};
  }
  return measured;
}

Pose cameraMotion(const MeasuredPose& before, const MeasuredPose& now) {
  if (before.reference >= 0 && before.reference == now.reference) {
    return before.reference_T_camera.inverse() * now.reference_T_camera;
  }
  return before.world_T_camera.inverse() * now.world_T_camera;
}

}  // namespace edgeslam
