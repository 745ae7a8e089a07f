#include "mapping/camera_finding.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
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
constexpr double times_less_known = 4;      // what errs together makes estimates err so many times as far as they say
constexpr int fewest_views_of_line = 3;

// How something is looked for. Values are readouts [s], logarithms of focal lengths, or distortions: by what share of
// their distance from the centre pixels are moved.
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
// A map that is bent takes up to 4 % even where the calibration is exact (forward motion, bare walls).
constexpr Looking looking_for_focal_length{0.02, 0.005, 0.04, 3, 3, 0.02, 0.01, 0.003, 0.01};
constexpr Looking looking_for_distortion{0.004, 0.0002, 0.004, 0, 3, 0.02, 0.001, 0.0003, 0.004};
constexpr double alike = 0.25;                  // estimates that differ by less of their value agree, too
constexpr double beyond_doubt = 8;              // standard deviations; only without a least change
constexpr double least_share = 0.02;            // of the cost: with the right lens some other one explains less ...
constexpr double least_gain = 4.5;              // ... and of the cost itself: three standard deviations
constexpr double most_change_at_once = 0.1;     // of focal length or distortion
constexpr int iterations_of_trial = 3;          // about a map that is adjusted; more find the same
constexpr double distortion_at[] = {0.5, 0.9};  // of the way from the centre to the farthest corner

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

// What only these keyframes say. What others say is by the camera that there was: it holds on to that one.
Map seenByThemselves(const std::vector<KeyframeId>& keyframes, Map map) {
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

// What the adjustment costs with a camera; infinity where it fails, and where pixels would be images of several
// directions.
double costWith(const LookedAt& at, const Camera& camera) {
  if (!isOneToOne(camera) && isOneToOne(at.camera)) return std::numeric_limits<double>::infinity();
  Map trial = at.map;
  takeRaysAnew(camera, withHosts(trial, at.keyframes), trial);
  double left = 0;
  const bool is_adjusted = adjustKeyframes(camera, at.adjustment, at.keyframes, {}, trial, nullptr, &left);
  return is_adjusted ? left : std::numeric_limits<double>::infinity();
}

// With which camera the adjustment costs least; `now`: the value of the one that the map's rays are of.
std::optional<CameraEstimate> leastCost(const LookedAt& at, const std::function<Camera(double)>& with, double now,
                                        double step, double limit) {
  const auto attempt = [&](double value) { return Trial{value, costWith(at, with(value))}; };
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

CameraEstimate focalLengthOf(const LensEstimate& estimate) {
  return {estimate.change(0), std::sqrt(estimate.covariance(0, 0))};
}

// Root mean square over both radii.
CameraEstimate distortionOf(const LensEstimate& estimate) {
  return {std::sqrt(0.5 * estimate.change.tail<2>().squaredNorm()),
          std::sqrt(0.5 * estimate.covariance.diagonal().tail<2>().sum())};
}

// Normalised, as calibrated; of a fisheye about its angle [rad].
double farthestCorner(const Camera& camera) {
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  return std::hypot(x, y);
}

double honestSigma(const Looking& looking, const CameraEstimate& estimate) {
  return std::hypot(times_less_known * estimate.sigma, looking.least_sigma);
}

// A change that is clearly one.
bool saysSo(const Looking& looking, const CameraEstimate& change) {
  return std::abs(change.value) > std::max(looking.least, looking.least_sigmas * honestSigma(looking, change));
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
  const double sigma = honestSigma(looking, estimate);
  const bool says_so = saysSo(looking, {change, estimate.sigma});
  const bool agrees = looks.agreeing > 0 && change * looks.last > 0 &&
                      std::abs(change - looks.last) < std::max(looking.agreement, alike * std::abs(change));
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
  LookedAt at{camera, local, keyframes, map, 0};
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

std::optional<LensEquations> lensEquations(const LookedAt& at) {
  const Eigen::Vector3d step(looking_for_focal_length.step, looking_for_distortion.step, looking_for_distortion.step);
  LookedAt trials = at;
  trials.adjustment.bundle.iterations = iterations_of_trial;
  const auto costOf = [&](int k, double times_k, int l, double times_l) {
    const Eigen::Vector3d change =
        times_k * step(k) * Eigen::Vector3d::Unit(k) + times_l * step(l) * Eigen::Vector3d::Unit(l);
    return costWith(trials, withFound(at.camera, withLens(at.camera, {}, change)));
  };
  LensEquations equations;
  for (int k = 0; k < 3; ++k) {
    const double ahead = costOf(k, 1, k, 0), behind = costOf(k, -1, k, 0);
    equations.gradient(k) = (ahead - behind) / (2 * step(k));
    equations.information(k, k) = (ahead - 2 * at.cost + behind) / (step(k) * step(k));
    for (int l = 0; l < k; ++l) {
      const double alike = costOf(k, 1, l, 1) + costOf(k, -1, l, -1);
      const double opposite = costOf(k, 1, l, -1) + costOf(k, -1, l, 1);
      equations.information(k, l) = equations.information(l, k) = (alike - opposite) / (4 * step(k) * step(l));
    }
  }
  if (!equations.gradient.allFinite() || !equations.information.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(equations.information, Eigen::EigenvaluesOnly);
  return parts.eigenvalues()(0) > 0 ? std::optional(equations) : std::nullopt;
}

LensEstimate estimateLens(const LensEquations& equations, bool focal_length, bool distortion) {
  const std::array<bool, 3> is_free{focal_length, distortion, distortion};
  Eigen::Matrix3d information = equations.information;
  Eigen::Vector3d gradient = equations.gradient;
  for (int k = 0; k < 3; ++k) {
    if (is_free[static_cast<std::size_t>(k)]) continue;
    information.row(k).setZero();
    information.col(k).setZero();
    information(k, k) = 1;
    gradient(k) = 0;
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(information);
  LensEstimate estimate;
  estimate.change = -factor.solve(gradient);
  estimate.covariance = factor.solve(Eigen::Matrix3d::Identity());
  estimate.gain = -0.5 * gradient.dot(estimate.change);
  return estimate;
}

FoundCamera withLens(const Camera& camera, const FoundCamera& found, const Eigen::Vector3d& change) {
  FoundCamera with = found;
  const double logarithm = std::clamp(std::log(found.focal_scale) + change(0), -most_focal_change, most_focal_change);
  with.focal_scale = inMillionths(std::exp(logarithm));
  Eigen::Matrix2d moves;  // at the two radii, by k1 and k2
  for (int k = 0; k < 2; ++k) {
    const double squared = std::pow(distortion_at[k] * farthestCorner(camera), 2);
    moves.row(k) << squared, squared * squared;
  }
  const Eigen::Vector2d radial = moves.inverse() * change.tail<2>();
  for (int k = 0; k < 2; ++k) {
    with.radial[static_cast<std::size_t>(k)] = inMillionths(found.radial[static_cast<std::size_t>(k)] + radial(k));
  }
  return with;
}

bool isOneToOne(const Camera& camera) {
  constexpr int steps = 200;
  constexpr double least_slope = 0.2, farthest_times = 3;
  const bool is_fisheye = camera.model == CameraModel::kannala_brandt;
  const std::array<double, 5>& k = camera.distortion;
  const std::array<double, 4> radial{k[0], k[1], is_fisheye ? k[2] : k[4], is_fisheye ? k[3] : 0};
  const double farthest = farthestCorner(camera);
  for (int i = 1; i <= steps; ++i) {
    const double r = farthest_times * farthest * i / steps, r2 = r * r;
    const double slope = 1 + r2 * (3 * radial[0] + r2 * (5 * radial[1] + r2 * (7 * radial[2] + r2 * 9 * radial[3])));
    if (!(slope > least_slope)) return false;
    if (r * (1 + r2 * (radial[0] + r2 * (radial[1] + r2 * (radial[2] + r2 * radial[3])))) > farthest) return true;
  }
  return false;
}

// As much of a change as takes off the cost what the equations say; or nothing of it.
Eigen::Vector3d worthwhile(const LookedAt& at, const LensEquations& equations, Eigen::Vector3d change) {
  constexpr int most_halvings = 3;
  constexpr double least_kept = 0.5;  // of the gain that is expected
  const double largest = change.cwiseAbs().maxCoeff();
  if (largest > most_change_at_once) change *= most_change_at_once / largest;
  for (int halved = 0; halved <= most_halvings; ++halved, change *= 0.5) {
    const double expected = -equations.gradient.dot(change) - 0.5 * change.dot(equations.information * change);
    const double gain = at.cost - costWith(at, withFound(at.camera, withLens(at.camera, {}, change)));
    if (expected > 0 && gain > least_kept * expected) return change;
  }
  return Eigen::Vector3d::Zero();
}

void CameraFinding::lookAtLens(const LookedAt& at, int keyframes, FoundCamera& found) {
  const std::optional<LensEquations> equations = lensEquations(at);
  if (!equations) return;
  const LensEstimate both = estimateLens(*equations, true, true);
  const double by_focal_length = estimateLens(*equations, true, false).gain;
  const double by_distortion = estimateLens(*equations, false, true).gain;
  const double enough = std::max(least_share * at.cost, times_less_known * times_less_known * least_gain);
  // What explains too little beside the other is as it was; where neither does, it is the one that explains more.
  const bool is_near = both.change.cwiseAbs().maxCoeff() < most_focal_change;
  const auto tells = [&](const Looking& looking, const CameraEstimate& estimate, double gain) {
    return gain > enough && saysSo(looking, estimate);
  };
  bool with_focal_length = focal_length_.was_found ||
                           (is_near && tells(looking_for_focal_length, focalLengthOf(both), both.gain - by_distortion));
  bool with_distortion = distortion_.was_found ||
                         (is_near && tells(looking_for_distortion, distortionOf(both), both.gain - by_focal_length));
  if (!with_focal_length && !with_distortion) {
    const bool is_focal_length = by_focal_length > by_distortion;
    with_focal_length = is_focal_length && tells(looking_for_focal_length,
                                                 focalLengthOf(estimateLens(*equations, true, false)), by_focal_length);
    with_distortion = !is_focal_length &&
                      tells(looking_for_distortion, distortionOf(estimateLens(*equations, false, true)), by_distortion);
  }
  const LensEstimate estimate = estimateLens(*equations, with_focal_length, with_distortion);
  const auto isChanged = [&](const Looking& looking, CameraEstimate of_it, bool explains, CameraLooks& looks) {
    if (!explains) of_it.value = 0;
    return !looks.is_settled && isToChange(looking, of_it, 0, keyframes, options_.most_keyframes, looks);
  };
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  if (isChanged(looking_for_focal_length, focalLengthOf(with_focal_length ? estimate : both), with_focal_length,
                focal_length_)) {
    change(0) = estimate.change(0);
  }
  if (isChanged(looking_for_distortion, distortionOf(with_distortion ? estimate : both), with_distortion,
                distortion_)) {
    change.tail<2>() = estimate.change.tail<2>();
  }
  // What is not sure yet beside it might explain it better.
  const bool is_alone = (with_focal_length && !focal_length_.was_found) || (with_distortion && !distortion_.was_found);
  if (is_alone) return;
  if (!change.isZero(0)) found = withLens(at.camera, found, worthwhile(at, *equations, change));
}

bool CameraFinding::look(const Camera& calibrated, const GlobalAdjustmentOptions& global,
                         const LocalAdjustmentOptions& local, Map& map) {
  if (calibrated.readout_s != 0) readout_.is_settled = true;
  const bool was_found = readout_.was_found || focal_length_.was_found || distortion_.was_found;
  if (isSettled() || ++since_look_ < (was_found ? options_.interval_found : options_.interval)) return false;
  const std::vector<KeyframeId> all = keyframesOf(map, map.keyframes.back().world);
  if (static_cast<int>(all.size()) < options_.fewest_keyframes) return false;
  const int keyframes = std::exchange(since_look_, 0);
  const Camera camera = withFound(calibrated, map.found);
  const std::vector<KeyframeId> latest = latestOf(all, options_.most_keyframes);
  FoundCamera found = map.found;
  if (!readout_.is_settled) {
    const std::optional<LookedAt> at = lookAt(camera, global, local, latest, map);
    const double longest_s = longestReadout(map, latest);
    const std::optional<CameraEstimate> estimate = at ? estimateReadout(*at, longest_s) : std::nullopt;
    if (estimate &&
        isToChange(looking_for_readout, *estimate, camera.readout_s, keyframes, options_.most_keyframes, readout_)) {
      found.readout_s = std::clamp(estimate->value, -longest_s, longest_s);
    }
  }
  if (!focal_length_.is_settled || !distortion_.is_settled) {
    const std::optional<LookedAt> at = lookAt(camera, global, local, latest, seenByThemselves(latest, map));
    if (at) lookAtLens(*at, keyframes, found);
  }
  if (++looks_ >= options_.most_looks) readout_.is_settled = focal_length_.is_settled = distortion_.is_settled = true;
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
