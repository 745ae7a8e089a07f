#include "places/reach.h"

#include <algorithm>

#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr double longest_step_s = 10;     // between successive keyframes of one run
constexpr double least_of_speed_s = 0.3;  // over which speed is measured: over less, poses err more than they move

double secondsBetween(const Keyframe& earlier, const Keyframe& later) {
  return 1e-9 * static_cast<double>(later.time_ns - earlier.time_ns);
}

double distanceBetween(const Keyframe& a, const Keyframe& b) {
  return (b.world_T_camera.translation - a.world_T_camera.translation).norm();
}

}  // namespace

Reachable reachableFrom(const Map& map, const Pose& world_T_camera, double seconds, int world) {
  double fastest = 0, farthest = 0;
  const Keyframe *before = nullptr, *start = nullptr;  // the keyframe before, and one from which speed is measured
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != world) {
      before = start = nullptr;
      continue;
    }
    const double step_s = before ? secondsBetween(*before, keyframe) : 0;
    const bool goes_on = step_s > 0 && step_s <= longest_step_s;  // between two runs there is no motion to learn from
    if (goes_on) farthest = std::max(farthest, distanceBetween(*before, keyframe));
    if (!goes_on) start = &keyframe;
    before = &keyframe;
    const double elapsed_s = secondsBetween(*start, keyframe);
    if (elapsed_s < least_of_speed_s) continue;
    fastest = std::max(fastest, distanceBetween(*start, keyframe) / elapsed_s);
    start = &keyframe;
  }
  return {world_T_camera.translation, std::max(farthest, 2 * fastest * seconds), world};
}

std::string outOfReach(const Map& map, const WorldJoin& join) {
  const Keyframe *last_from = nullptr, *last_to = nullptr;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != join.from && keyframe.world != join.to) continue;
    const bool is_from = keyframe.world == join.from;
    const Keyframe *&own = is_from ? last_from : last_to, *other = is_from ? last_to : last_from;
    const bool comes_from_other = other && (!own || own->id < other->id);
    own = &keyframe;
    if (!comes_from_other) continue;
    const double seconds = secondsBetween(*other, keyframe);
    if (seconds <= 0) continue;
    const Pose in_from = (is_from ? keyframe : *other).world_T_camera,
               in_to = (is_from ? *other : keyframe).world_T_camera;
    const double distance = (join.to_S_from * in_from.translation - in_to.translation).norm();
    const double can = std::max(reachableFrom(map, in_to, seconds, join.to).distance,
                                join.to_S_from.scale * reachableFrom(map, in_from, seconds, join.from).distance);
    if (distance > can) {
      return formatted("the camera would have come by %.2f in %.2f s while it was lost, it can by %.2f", distance,
                       seconds, can);
    }
  }
  return "";
}

}  // namespace edgeslam
