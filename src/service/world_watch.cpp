#include "service/world_watch.h"

#include <utility>

#include "scale/measured_pose.h"

namespace edgeslam {

void WorldWatch::begin() {
  seen_.clear();
  world_ = -1;
  why_lost_.clear();
}

std::optional<std::string> WorldWatch::frame(const FrameResult& result) {
  const int world = isGoodPose(result.state) ? worldOf(result) : -1;
  if (world < 0) {
    if (result.state == TrackingState::lost) why_lost_ = result.reason;
    return std::nullopt;
  }
  const std::string why_lost = std::exchange(why_lost_, "");
  const int before = std::exchange(world_, world);
  const bool is_new = seen_.insert(world).second;
  if (before < 0 || before == world) return std::nullopt;
  const std::string map = "map " + std::to_string(world), last = "map " + std::to_string(before);
  if (is_new) return map + " is begun beside " + last + (why_lost.empty() ? "" : ": lost there, " + why_lost);
  if (result.state == TrackingState::tracking) {
    seen_.erase(before);
    return last + " is joined to " + map + ": they are of the same place";
  }
  return "back in " + map + " from " + last + ": found again there";
}

}  // namespace edgeslam
