#include "mapping/wheel_turn_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr double least_turn = 0.02;    // [rad], of two keyframes against each other: others say nothing of turns
constexpr double enough_turned = 1.5;  // [rad], in all
constexpr double allowed_share = 0.05;

}  // namespace

std::string turnContradiction(const WheelOptions& wheels, const Map& map, int world) {
  double by_wheels = 0, by_camera = 0;
  const Keyframe* before = nullptr;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != world) continue;
    const Keyframe* first = std::exchange(before, &keyframe);
    const std::optional<WheelMotion> motion =
        first ? wheelMotion(wheels, first->wheels, keyframe.wheels) : std::nullopt;
    if (!motion) continue;
    const Eigen::Vector3d turn = rotationLog(motion->first_T_second.rotation);
    if (turn.norm() < least_turn) continue;
    const Eigen::Quaterniond turned = first->world_T_camera.rotation.conjugate() * keyframe.world_T_camera.rotation;
    by_wheels += turn.norm();
    by_camera += rotationLog(turned.normalized()).dot(turn.normalized());
  }
  if (by_wheels < enough_turned) return "";
  const double more = by_camera / by_wheels - 1;
  if (std::abs(more) <= allowed_share) return "";
  return formatted("the camera turns %.0f %% %s than the wheels: is its focal length right, or the odometry's turn?",
                   100 * std::abs(more), more < 0 ? "less" : "more");
}

}  // namespace edgeslam
