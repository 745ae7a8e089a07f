#include "mapping/camera_finding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "map/worlds.h"
#include "mapping/rays_anew.h"

namespace edgeslam {
namespace {

constexpr double longest_tried_s = 0.05;    // no camera takes longer
constexpr double most_focal_change = 0.25;  // of the logarithm
constexpr double honest_times = 4;          // what errs together makes estimates err so many times as far as they say

// How something is looked for. Values are readouts [s], or logarithms of focal lengths.
struct Looking {
  double step;          // between values that are tried
  double least_sigma;   // none is known better
  double least;         // over so much and ...
  double least_sigmas;  // ... so many standard deviations, it is not as presumed
  int agreeing_looks;   // if so many say so, or one beyond doubt, within ...
  double agreement;     // ... this of each other
  double little;        // a change by less is none, for what has come to stay ...
  double too_little;    // ... and by less the map is not adjusted
  double well_known;    // standard deviation with which looks that find nothing count
};
constexpr Looking looking_for_readout{0.006, 0.0005, 0, 3, 2, longest_tried_s, 0.001, 0.0003, 0.002};
// A map that is bent takes up to 2 % even where the calibration is exact (forward motion, bare walls).
constexpr Looking looking_for_focal_length{0.02, 0.005, 0.04, 3, 3, 0.02, 0.01, 0.003, 0.01};
constexpr double beyond_doubt = 8;  // standard deviations; only without a least change

std::vector<KeyframeId> latestOf(std::vector<KeyframeId> keyframes, int most) {
  if (static_cast<int>(keyframes.size()) > most) keyframes.erase(keyframes.begin(), keyframes.end() - most);
  return keyframes;
}

// No row is read in more time than passes from one frame to the next.
double longestReadout(const Map& map, const std::vector<KeyframeId>& keyframes) {
  double longest_s = longest_tried_s;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const std::int64_t since = map.keyframes[keyframes[k]].time_ns - map.keyframes[keyframes[k - 1]].time_ns;
    longest_s = std::min(longest_s, std::abs(1e-9 * static_cast<double>(since)));
  }
  return longest_s;
}

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

struct Trial {
  double value, cost;
};

// Where the parabola through three trials is lowest.
std::optional<CameraEstimate> lowestOf(const std::array<Trial, 3>& trials) {
  const auto& [before, middle, after] = trials;
  const double falls = (middle.cost - before.cost) / (middle.value - before.value);
  const double rises = (after.cost - middle.cost) / (after.value - middle.value);
  const double curvature = 2 * (rises - falls) / (after.value - before.value);
  if (!(curvature > 0) || !std::isfinite(curvature)) return std::nullopt;
  return CameraEstimate{0.5 * (before.value + middle.value) - falls / curvature, 1 / std::sqrt(curvature)};
}

// With which camera the adjustment costs least; `now`: the value of the one that the map's rays are of.
std::optional<CameraEstimate> leastCost(const LookedAt& at, const std::function<Camera(double)>& with, double now,
                                        double step, double limit) {
  const std::vector<KeyframeId> seen_from = withHosts(at.map, at.keyframes);
  const auto attempt = [&](double value) {
    Map trial = at.map;
    takeRaysAnew(with(value), seen_from, trial);
    double left = 0;
    const bool is_adjusted = adjustKeyframes(with(value), at.adjustment, at.keyframes, {}, trial, nullptr, &left);
    return Trial{value, is_adjusted ? left : std::numeric_limits<double>::infinity()};
  };
  std::array<Trial, 3> trials{attempt(now - step), {now, at.cost}, attempt(now + step)};
  // Downhill until it rises.
  while (trials[2].cost < trials[1].cost && trials[2].value < limit) {
    trials = {trials[1], trials[2], attempt(trials[2].value + step)};
  }
  while (trials[0].cost < trials[1].cost && trials[0].value > -limit) {
    trials = {attempt(trials[0].value - step), trials[0], trials[1]};
  }
  return lowestOf(trials);
}

// True where the value that there is now is to change, after one more look.
// `keyframes`: since the look before. It is settled when it stays for `enough` keyframes.
bool isToChange(const Looking& looking, const CameraEstimate& estimate, double now, int keyframes, int enough,
                CameraLooks& looks) {
  const double change = estimate.value - now;
  if (looks.was_found) {
    looks.steady = std::abs(change) < looking.little ? looks.steady + keyframes : 0;
    looks.is_settled = looks.steady >= enough;
    return std::abs(change) > looking.too_little;
  }
  const double sigma = std::hypot(honest_times * estimate.sigma, looking.least_sigma);
  const bool says_so = std::abs(change) > std::max(looking.least, looking.least_sigmas * sigma);
  const bool agrees =
      looks.agreeing > 0 && change * looks.last > 0 && std::abs(change - looks.last) < looking.agreement;
  looks.agreeing = !says_so ? 0 : agrees ? looks.agreeing + 1 : 1;
  looks.last = change;
  looks.steady = !says_so && sigma < looking.well_known ? looks.steady + keyframes : 0;
  looks.is_settled = looks.steady >= enough;
  const bool is_beyond_doubt = looking.least == 0 && std::abs(change) > beyond_doubt * sigma;
  looks.was_found = is_beyond_doubt || looks.agreeing >= looking.agreeing_looks;
  return looks.was_found;
}

}  // namespace

std::optional<LookedAt> lookAt(const Camera& camera, const GlobalAdjustmentOptions& global,
                               const LocalAdjustmentOptions& local, const std::vector<KeyframeId>& keyframes,
                               const Map& map) {
  LookedAt at{camera, local, keyframes, map};
  at.adjustment.bundle = global.bundle;
  // All take part in each trial: what fits badly with one camera may fit with another.
  at.adjustment.outlier = std::numeric_limits<double>::infinity();
  if (!adjustKeyframes(camera, at.adjustment, keyframes, {}, at.map, nullptr, &at.cost)) return std::nullopt;
  return at;
}

std::optional<CameraEstimate> estimateReadout(const LookedAt& at, double longest_s) {
  const auto with = [&](double readout_s) {
    Camera camera = at.camera;
    camera.readout_s = readout_s;
    return camera;
  };
  return leastCost(at, with, at.camera.readout_s, looking_for_readout.step, longest_s);
}

std::optional<CameraEstimate> estimateFocalLength(const LookedAt& at) {
  const auto with = [&](double logarithm) { return withFound(at.camera, {std::nullopt, std::exp(logarithm)}); };
  return leastCost(at, with, 0, looking_for_focal_length.step, most_focal_change);
}

bool CameraFinding::look(const Camera& calibrated, const GlobalAdjustmentOptions& global,
                         const LocalAdjustmentOptions& local, Map& map) {
  if (calibrated.readout_s != 0) readout_.is_settled = true;
  const bool was_found = readout_.was_found || focal_length_.was_found;
  if (isSettled() || ++since_look_ < (was_found ? options_.interval_found : options_.interval)) return false;
  const std::vector<KeyframeId> all = keyframesOf(map, map.keyframes.back().world);
  if (static_cast<int>(all.size()) < options_.fewest_keyframes) return false;
  const int keyframes = std::exchange(since_look_, 0);
  const Camera camera = withFound(calibrated, map.found);
  const std::vector<KeyframeId> latest = latestOf(all, options_.most_keyframes);
  const std::optional<LookedAt> at = lookAt(camera, global, local, latest, map);
  if (!at) return false;
  FoundCamera found = map.found;
  if (!readout_.is_settled) {
    const double longest_s = longestReadout(map, latest);
    const auto estimate = estimateReadout(*at, longest_s);
    if (estimate &&
        isToChange(looking_for_readout, *estimate, camera.readout_s, keyframes, options_.most_keyframes, readout_)) {
      found.readout_s = std::clamp(estimate->value, -longest_s, longest_s);
    }
  }
  if (!focal_length_.is_settled) {
    const auto estimate = estimateFocalLength(*at);
    if (estimate &&
        isToChange(looking_for_focal_length, *estimate, 0, keyframes, options_.most_keyframes, focal_length_)) {
      const double logarithm = std::log(map.found.focal_scale) + estimate->value;
      found.focal_scale = focalScale(std::exp(std::clamp(logarithm, -most_focal_change, most_focal_change)));
    }
  }
  if (++looks_ >= options_.most_looks) readout_.is_settled = focal_length_.is_settled = true;
  if (found == map.found) return false;
  map.found = found;
  std::vector<KeyframeId> of_map;
  for (const Keyframe& keyframe : map.keyframes) of_map.push_back(keyframe.id);
  takeRaysAnew(withFound(calibrated, found), of_map, map);
  LocalAdjustmentOptions adjustment = local;
  adjustment.bundle = global.bundle;
  adjustKeyframes(withFound(calibrated, found), adjustment, latestOf(all, options_.whole_map), {}, map);
  return true;
}

}  // namespace edgeslam
