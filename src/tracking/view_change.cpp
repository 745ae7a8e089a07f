#include "tracking/view_change.h"

namespace edgeslam {
namespace {

// Where the latest keyframe that both know is in the one view and in the other; null where they share none.
struct SharedKeyframes {
  const ViewKeyframe *in_old = nullptr, *in_new = nullptr;
};

SharedKeyframes latestShared(const MapView& old_view, const MapView& new_view) {
  for (std::size_t place = new_view.keyframes.size(); place-- > 0;) {
    const ViewKeyframe& keyframe = new_view.keyframes.atPlace(place);
    if (const ViewKeyframe* in_old = old_view.keyframes.find(keyframe.id)) return {in_old, &keyframe};
  }
  return {};
}

// How much longer lengths became where a world was joined to another: that between the keyframes that are farthest
// apart of those that both know. Otherwise what changes with drift is left to the next pose.
double newUnitsAnOldUnit(const MapView& old_view, const MapView& new_view, const SharedKeyframes& latest) {
  if (old_view.world == new_view.world) return 1;
  double farthest = 0, ratio = 1;
  for (const ViewKeyframe& keyframe : new_view.keyframes) {
    const ViewKeyframe* before = old_view.keyframes.find(keyframe.id);
    if (!before) continue;
    const double old_distance = (before->world_T_camera.translation - latest.in_old->world_T_camera.translation).norm();
    if (old_distance <= farthest) continue;
    farthest = old_distance;
    ratio = (keyframe.world_T_camera.translation - latest.in_new->world_T_camera.translation).norm() / old_distance;
  }
  return ratio;
}

}  // namespace

std::optional<Similarity> newWorldSOldWorld(const MapView& old_view, const MapView& new_view) {
  const SharedKeyframes latest = latestShared(old_view, new_view);
  if (!latest.in_new) return std::nullopt;
  const Pose &new_pose = latest.in_new->world_T_camera, &old_pose = latest.in_old->world_T_camera;
  const double scale = newUnitsAnOldUnit(old_view, new_view, latest);
  const Eigen::Quaterniond rotation = (new_pose.rotation * old_pose.rotation.conjugate()).normalized();
  return Similarity{scale, rotation, new_pose.translation - scale * (rotation * old_pose.translation)};
}

}  // namespace edgeslam
