#include "mapping/readout_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double longest_tried_s = 0.05;
constexpr double step_s = 0.006;  // between those that are tried

struct Trial {
  double readout_s, cost;
};

// Where the parabola through three trials is lowest.
std::optional<CameraEstimate> lowestOf(const std::array<Trial, 3>& trials) {
  const auto& [before, middle, after] = trials;
  const double falls = (middle.cost - before.cost) / (middle.readout_s - before.readout_s);
  const double rises = (after.cost - middle.cost) / (after.readout_s - middle.readout_s);
  const double curvature = 2 * (rises - falls) / (after.readout_s - before.readout_s);
  if (!(curvature > 0) || !std::isfinite(curvature)) return std::nullopt;
  return CameraEstimate{0.5 * (before.readout_s + middle.readout_s) - falls / curvature, 1 / std::sqrt(curvature)};
}

}  // namespace

double longestReadout(const Map& map, const std::vector<KeyframeId>& keyframes) {
  double longest_s = longest_tried_s;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const std::int64_t since = map.keyframes[keyframes[k]].time_ns - map.keyframes[keyframes[k - 1]].time_ns;
    if (since != 0) longest_s = std::min(longest_s, std::abs(1e-9 * static_cast<double>(since)));
  }
  return longest_s;
}

std::optional<CameraEstimate> estimateReadout(const LookedAt& at, double longest_s) {
  const auto attempt = [&](double readout_s) {
    Camera camera = at.camera;
    camera.readout_s = readout_s;
    return Trial{readout_s, costWith(at, camera)};
  };
  const double now_s = at.camera.readout_s;
  std::array<Trial, 3> trials{attempt(now_s - step_s), {now_s, at.cost}, attempt(now_s + step_s)};
  // Downhill until it rises.
  while (trials[2].cost < trials[1].cost && trials[2].readout_s < longest_s) {
    trials = {trials[1], trials[2], attempt(trials[2].readout_s + step_s)};
  }
  while (trials[0].cost < trials[1].cost && trials[0].readout_s > -longest_s) {
    trials = {attempt(trials[0].readout_s - step_s), trials[0], trials[1]};
  }
  return lowestOf(trials);
}

}  // namespace edgeslam
