#include "inertia/camera_turns.h"

#include <cmath>
#include <cstddef>

namespace edgeslam {

std::vector<CameraTurn> cameraTurns(const std::vector<PosedCamera>& poses, double seconds) {
  const std::int64_t shortest_ns = std::llround(seconds * 1e9), longest_ns = shortest_ns + shortest_ns / 2;
  std::vector<CameraTurn> turns;
  std::size_t to = 0;
  for (const PosedCamera& from : poses) {
    while (to < poses.size() && poses[to].time_ns < from.time_ns + shortest_ns) ++to;
    if (to == poses.size()) break;
    if (poses[to].world != from.world || poses[to].time_ns > from.time_ns + longest_ns) continue;
    const Eigen::Quaterniond rotation = from.world_T_camera.rotation.conjugate() * poses[to].world_T_camera.rotation;
    turns.push_back({from.time_ns, poses[to].time_ns, rotation.normalized()});
  }
  return turns;
}

double secondsOf(const CameraTurn& turn) { return static_cast<double>(turn.to_ns - turn.from_ns) * 1e-9; }

}  // namespace edgeslam
