#include "report/display_frame.h"

#include <array>

namespace edgeslam {

DisplayFrame displayFrame(const RunResult& result, const RunSummary& summary) {
  std::optional<Similarity> reference_T_world;
  if (summary.errors.trajectory) reference_T_world = summary.errors.trajectory->reference_T_estimate;
  return displayFrame(finalTrajectory(result, result.main_world), reference_T_world);
}

DisplayFrame displayFrame(const Trajectory& trajectory, const std::optional<Similarity>& reference_T_world) {
  DisplayFrame frame;
  Eigen::Matrix3d turn;  // rows: the display's axes
  if (!reference_T_world) {
    turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    frame.display_T_world.rotation = Eigen::Quaterniond(turn);
    return frame;
  }
  Eigen::Vector3d camera_up = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : trajectory) {
    camera_up -= reference_T_world->rotation * (pose.world_T_camera.rotation * Eigen::Vector3d::UnitY());
  }
  camera_up.normalize();
  turn.setIdentity();
  frame.x_name = "x", frame.y_name = "y", frame.z_name = "z";
  if (camera_up.z() < 0.3 && camera_up.cwiseAbs().maxCoeff() > 0.8) {
    int axis = 0;
    camera_up.cwiseAbs().maxCoeff(&axis);
    const double sign = camera_up[axis] > 0 ? 1 : -1;
    const std::array<std::string, 3> names{"x", "y", "z"};
    const int right = axis == 0 ? 1 : 0;
    turn.setZero();
    turn(2, axis) = sign;
    turn(0, right) = 1;
    turn.row(1) = turn.row(2).cross(turn.row(0));
    int forward = 0;
    turn.row(1).cwiseAbs().maxCoeff(&forward);
    frame.x_name = names[static_cast<std::size_t>(right)];
    frame.y_name = (turn(1, forward) < 0 ? "-" : "") + names[static_cast<std::size_t>(forward)];
    frame.z_name = (sign < 0 ? "-" : "") + names[static_cast<std::size_t>(axis)];
  }
  frame.display_R_reference = Eigen::Quaterniond(turn);
  Similarity display_T_reference;
  display_T_reference.rotation = frame.display_R_reference;
  frame.display_T_world = display_T_reference * *reference_T_world;
  frame.aligned = true;
  return frame;
}

}  // namespace edgeslam
