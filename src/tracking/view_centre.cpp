#include "tracking/view_centre.h"

#include "geometry/angles.h"

namespace edgeslam {
namespace {

constexpr double depths_like_a_turn = 0.7;  // moved so many of the scene's depths, the map looks as changed ...
constexpr double turn_deg = 40;             // ... as turned by this angle
constexpr double clearly_nearer = 0.7;      // of the current one's distance

double distanceTo(const ViewKeyframe& keyframe, const Pose& world_T_camera, double scene_depth) {
  const double moved = (keyframe.world_T_camera.translation - world_T_camera.translation).norm();
  const double turned = degrees(rotationAngle(keyframe.world_T_camera.rotation, world_T_camera.rotation));
  return moved / (depths_like_a_turn * scene_depth) + turned / turn_deg;
}

}  // namespace

KeyframeId nearestKeyframe(const MapView& view, const Pose& world_T_camera, double scene_depth, KeyframeId current) {
  const ViewKeyframe* nearest = view.keyframes.find(current);
  double least = nearest ? clearly_nearer * distanceTo(*nearest, world_T_camera, scene_depth) : 0;
  for (const ViewKeyframe& keyframe : view.keyframes) {
    const double distance = distanceTo(keyframe, world_T_camera, scene_depth);
    if (nearest && distance >= least) continue;
    nearest = &keyframe;
    least = distance;
  }
  return nearest ? nearest->id : current;
}

}  // namespace edgeslam
