#include "mapping/camera_trial.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "geometry/distortion_reach.h"
#include "mapping/rays_anew.h"

namespace edgeslam {
namespace {

// And those in which points are hosted that they see.
std::vector<KeyframeId> withHosts(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::set<KeyframeId> all(keyframes.begin(), keyframes.end());
  for (const KeyframeId id : keyframes) {
    for (const PointObservation& seen : map.keyframes[id].observations) {
      const auto point = map.points.find(seen.point);
      if (point != map.points.end()) all.insert(point->second.host);
    }
  }
  return {all.begin(), all.end()};
}

}  // namespace

std::optional<LookedAt> lookAt(const Camera& camera, const GlobalAdjustmentOptions& global,
                               const LocalAdjustmentOptions& local, const std::vector<KeyframeId>& keyframes,
                               const Map& map) {
  LookedAt at{camera, local, keyframes, map, 0};
  at.adjustment.bundle = global.bundle;
  // All take part in each trial: what fits badly with one camera may fit with another.
  at.adjustment.outlier = std::numeric_limits<double>::infinity();
  if (!adjustKeyframes(camera, at.adjustment, keyframes, {}, at.map)) return std::nullopt;
  // By that, lines may have been dissolved or come to stand: what is to be held against trials begins where they do.
  at.cost = costWith(at, camera);
  if (!std::isfinite(at.cost)) return std::nullopt;
  return at;
}

Map seenBy(const std::vector<KeyframeId>& keyframes, Map map) {
  constexpr int fewest_views_of_line = 3;
  const std::set<KeyframeId> themselves(keyframes.begin(), keyframes.end());
  for (auto point = map.points.begin(); point != map.points.end();) {
    point = themselves.count(point->second.host) > 0 ? std::next(point) : map.points.erase(point);
  }
  for (auto& [id, line] : map.lines) {
    std::vector<KeyframeId>& seen_in = line.seen_in;
    seen_in.erase(
        std::remove_if(seen_in.begin(), seen_in.end(), [&](KeyframeId k) { return themselves.count(k) == 0; }),
        seen_in.end());
    if (static_cast<int>(seen_in.size()) < fewest_views_of_line) line.is_placed = false;
  }
  return map;
}

double costWith(const LookedAt& at, const Camera& camera) {
  if (!reachesCorners(camera) && reachesCorners(at.camera)) return std::numeric_limits<double>::infinity();
  Map trial = at.map;
  takeRaysAnew(camera, withHosts(trial, at.keyframes), trial);
  double left = 0;
  const bool is_adjusted = adjustKeyframes(camera, at.adjustment, at.keyframes, {}, trial, nullptr, &left);
  return is_adjusted ? left : std::numeric_limits<double>::infinity();
}

double worthwhileShare(const LookedAt& at, const std::function<Camera(double)>& with,
                       const std::function<double(double)>& expected_gain) {
  constexpr double least_share = 0.125, least_kept = 0.5;
  for (double share = 1; share >= least_share; share *= 0.5) {
    const double expected = expected_gain(share);
    if (expected > 0 && at.cost - costWith(at, with(share)) > least_kept * expected) return share;
  }
  return 0;
}

}  // namespace edgeslam
