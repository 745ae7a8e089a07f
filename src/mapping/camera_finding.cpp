#include "mapping/camera_finding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "map/worlds.h"
#include "mapping/lens_estimate.h"
#include "mapping/principal_point_estimate.h"
#include "mapping/rays_anew.h"

namespace edgeslam {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double longest_tried_s = 0.05;    // no camera takes longer
constexpr double readout_step_s = 0.006;    // between those that are tried
constexpr double farthest_believed = 0.25;  // change of the lens: beyond it the trials do not say
constexpr double times_less_known = 4;      // what errs together makes estimates err so many times as far as they say

// How something is looked for. Values are readouts [s], logarithms of focal lengths, or distortions: by what share of
// their distance from the centre pixels are moved.
struct Looking {
  double least_sigma;   // none is known better
  double least;         // over so much and ...
  double least_sigmas;  // ... so many standard deviations, it is not as presumed
  int agreeing_looks;   // if so many say so, or one beyond doubt, within ...
  double agreement;     // ... this of each other
  double little;        // a change by less is none, for what has come to stay ...
  double too_little;    // ... and by less the map is not adjusted
  double well_known;    // standard deviation with which looks that find nothing count
};
constexpr Looking looking_for_readout{0.0005, 0, 3, 2, longest_tried_s, 0.001, 0.0003, 0.002};
constexpr Looking looking_for_focal_length{0.005, 0.01, 2, 3, 0.02, 0.01, 0.003, 0.01};
constexpr Looking looking_for_focal_length_beside_distortion{0.005, 0.03, 3, 3, 0.02, 0.01, 0.003, 0.01};
constexpr Looking looking_for_distortion{0.0002, 0.004, 0, 3, 0.02, 0.001, 0.0003, 0.004};
constexpr double alike = 0.25;        // estimates that differ by less of their value agree, too
constexpr double beyond_doubt = 8;    // standard deviations; only without a least change
constexpr double least_share = 0.02;  // of the cost: with the right lens some other one explains less ...
constexpr double least_gain = 2;      // ... and of the cost itself: two standard deviations
constexpr double clearly_more = 2;    // by itself: of the two a focal length is calibrated rather than a distortion ...
constexpr double most_of_distortion = 0.04;  // ... which looks like so much of a focal length
constexpr double most_change_of_calibrated = 0.25, most_change_of_presumed = 0.7;  // logarithm of the focal lengths
constexpr double farthest_steps = 5;   // of trials of a lens that is presumed
constexpr double far_off_share = 0.2;  // of the cost: a lens that explains so much is far off; only whereto is known
constexpr double hardly_any = 0.25;    // of that gain: with others it does not come to more

// Of the principal point [px].
struct LookingForPrincipalPoint {
  double least_sigma = 0.5;             // none is known better
  double well_known = 2;                // standard deviation with which a look counts, ...
  double least_sigmas = 3;              // ... if the change is so many of them ...
  double least_share = 0.025;           // ... and explains so much of the cost
  int agreeing_looks = 3;               // if so many looks in a row say so, within as many standard deviations, ...
  double beyond_doubt = 0.1;            // ... or one that explains so much of the cost, it is not as presumed
  double little = 1, too_little = 0.3;  // as above
  double most_change = 0.05;            // of the longer side, over the calibration's
};
constexpr LookingForPrincipalPoint looking_for_principal_point;

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

double honestSigma(const Looking& looking, const CameraEstimate& estimate) {
  return std::hypot(times_less_known * estimate.sigma, looking.least_sigma);
}

// A change that is clearly one.
bool saysSo(const Looking& looking, const CameraEstimate& change) {
  return std::abs(change.value) > std::max(looking.least, looking.least_sigmas * honestSigma(looking, change));
}

// True where the value that there is now is to change, after one more look. `keyframes`: since the look before. It is
// settled when it stays for `enough` keyframes. Looks at what `is_far_off` agree where they say to which side.
bool isToChange(const Looking& looking, const CameraEstimate& estimate, double now, int keyframes, int enough,
                CameraLooks& looks, bool is_far_off = false) {
  const double change = estimate.value - now;
  if (looks.was_found) {
    looks.steady = std::abs(change) < looking.little ? looks.steady + keyframes : 0;
    looks.is_settled = looks.steady >= enough;
    return std::abs(change) > looking.too_little;
  }
  const double sigma = honestSigma(looking, estimate);
  const bool says_so = saysSo(looking, {change, estimate.sigma});
  const bool is_alike =
      is_far_off || std::abs(change - looks.last) < std::max(looking.agreement, alike * std::abs(change));
  const bool agrees = looks.agreeing > 0 && change * looks.last > 0 && is_alike;
  looks.agreeing = !says_so ? 0 : agrees ? looks.agreeing + 1 : 1;
  looks.last = change;
  looks.steady = !says_so && sigma < looking.well_known ? looks.steady + keyframes : 0;
  looks.rests = looks.steady >= enough;
  const bool is_beyond_doubt = looking.least == 0 && std::abs(change) > beyond_doubt * sigma;
  looks.was_found = is_beyond_doubt || looks.agreeing >= looking.agreeing_looks;
  return looks.was_found;
}

// Of the cost, by what is to count.
double enoughGain(double cost) {
  return std::max(least_share * cost, times_less_known * times_less_known * least_gain);
}

// What of the lens the trials tell to be other than it is presumed. What explains too little beside the other is as it
// was; where neither does, it is the one that explains more.
struct ToldOfLens {
  bool focal_length = false, distortion = false;
};
ToldOfLens toldOfLens(const LensEquations& equations, double cost) {
  const LensEstimate both = estimateLens(equations, true, true);
  const LensEstimate focal_length = estimateLens(equations, true, false);
  const LensEstimate distortion = estimateLens(equations, false, true);
  const double enough = enoughGain(cost);
  const auto tells = [&](const Looking& looking, const CameraEstimate& estimate, double gain) {
    return gain > enough && saysSo(looking, estimate);
  };
  ToldOfLens told;
  if (both.change.cwiseAbs().maxCoeff() < farthest_believed) {
    // A distortion that is left out looks like a focal length that is a little off.
    const bool is_mostly_focal_length = both.gain > clearly_more * distortion.gain;
    told.focal_length =
        tells(is_mostly_focal_length ? looking_for_focal_length : looking_for_focal_length_beside_distortion,
              focalLengthOf(both), both.gain - distortion.gain);
    told.distortion = tells(looking_for_distortion, distortionOf(both), both.gain - focal_length.gain);
  }
  if (told.focal_length || told.distortion) return told;
  const bool may_be_focal_length = tells(looking_for_focal_length, focalLengthOf(focal_length), focal_length.gain);
  const bool may_be_distortion = tells(looking_for_distortion, distortionOf(distortion), distortion.gain);
  const bool is_little = std::abs(focal_length.change(0)) < most_of_distortion;
  const double times_as_much = may_be_distortion && is_little ? clearly_more : 1;
  told.focal_length = may_be_focal_length && focal_length.gain > times_as_much * distortion.gain;
  told.distortion = may_be_distortion && !told.focal_length;
  return told;
}

double enoughGainOfPrincipalPoint(double cost) {
  return std::max(enoughGain(cost), looking_for_principal_point.least_share * cost);
}

// The same of the principal point, which has a gain that is `enough_gain`, or even `explains_it`.
bool isToChange(const PrincipalPointEstimate& estimate, double enough_gain, bool explains_it, int keyframes, int enough,
                PrincipalPointLooks& looks) {
  const LookingForPrincipalPoint& looking = looking_for_principal_point;
  const double length = estimate.change.norm();
  if (looks.was_found) {
    looks.steady = length < looking.little ? looks.steady + keyframes : 0;
    looks.is_settled = looks.steady >= enough;
    return length > looking.too_little;
  }
  const double sigma = std::hypot(times_less_known * estimate.sigma, looking.least_sigma);
  const double far = looking.least_sigmas * sigma;
  const bool says_so = sigma < looking.well_known && length > far && estimate.gain > enough_gain;
  const bool agrees = looks.agreeing > 0 && (estimate.change - looks.last).norm() < far;
  looks.agreeing = !says_so ? 0 : agrees ? looks.agreeing + 1 : 1;
  looks.last = estimate.change;
  looks.was_found = (says_so && explains_it) || looks.agreeing >= looking.agreeing_looks;
  return looks.was_found;
}

}  // namespace

std::optional<CameraEstimate> estimateReadout(const LookedAt& at, double longest_s) {
  const auto with = [&](double readout_s) {
    Camera camera = at.camera;
    camera.readout_s = readout_s;
    return camera;
  };
  return leastCost(at, with, at.camera.readout_s, readout_step_s, longest_s);
}

void CameraFinding::lookAtLens(const LookedAt& at, int keyframes, FoundCamera& found) {
  const bool was_found = focal_length_.was_found || distortion_.was_found;
  const auto equations = lensEquations(at, was_found ? 0 : hardly_any * enoughGain(at.cost),
                                       options_.lens_is_presumed ? farthest_steps : infinity);
  if (!equations) return;
  ToldOfLens told;
  if (!focal_length_.was_found || !distortion_.was_found) told = toldOfLens(*equations, at.cost);
  const bool with_focal_length = focal_length_.was_found || told.focal_length;
  const bool with_distortion = distortion_.was_found || told.distortion;
  const LensEstimate estimate = estimateLens(*equations, with_focal_length, with_distortion);
  const LensEstimate both = estimateLens(*equations, true, true);
  const bool is_far_off = options_.lens_is_presumed && estimate.gain > far_off_share * at.cost;
  const auto isChanged = [&](const Looking& looking, CameraEstimate of_it, bool is_told, CameraLooks& looks) {
    if (!is_told) of_it.value = 0;
    return !looks.is_settled && isToChange(looking, of_it, 0, keyframes, options_.most_keyframes, looks, is_far_off);
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
  // One waits for the other: what is told, but not for sure yet, may explain it better.
  const bool waits = (with_focal_length && !focal_length_.was_found) || (with_distortion && !distortion_.was_found);
  if (waits || change.isZero(0)) return;
  found = withLens(at.camera, found, worthwhile(at, *equations, change),
                   options_.lens_is_presumed ? most_change_of_presumed : most_change_of_calibrated);
}

// Where the lens is as the trials say, these may say more of where its axis is.
void CameraFinding::lookAtPrincipalPoint(const LookedAt& at, int keyframes, FoundCamera& found) {
  const double enough = enoughGainOfPrincipalPoint(at.cost);
  const std::optional<PrincipalPointEstimate> estimate =
      estimatePrincipalPoint(at, principal_point_.was_found ? 0 : hardly_any * enough);
  if (!estimate) {
    principal_point_.agreeing = 0;
    return;
  }
  const bool explains_it = estimate->gain > looking_for_principal_point.beyond_doubt * at.cost;
  if (!isToChange(*estimate, enough, explains_it, keyframes, options_.most_keyframes, principal_point_)) return;
  const Eigen::Vector2d change = worthwhile(at, *estimate);
  const double farthest = looking_for_principal_point.most_change * std::max(at.camera.width, at.camera.height);
  for (std::size_t k = 0; k < found.principal_point.size(); ++k) {
    const double moved = found.principal_point[k] + change(static_cast<Eigen::Index>(k));
    found.principal_point[k] = inMillionths(std::clamp(moved, -farthest, farthest));
  }
}

bool CameraFinding::isSettled() const {
  const auto stays = [](const CameraLooks& looks) { return looks.is_settled || looks.rests; };
  const bool principal_point_stays = !principal_point_.was_found || principal_point_.is_settled;
  return !options_.is_enabled ||
         (stays(readout_) && stays(focal_length_) && stays(distortion_) && principal_point_stays);
}

bool CameraFinding::isDue(const CameraLooks& looks, int keyframes) const {
  if (looks.is_settled) return false;
  if (looks.rests) return keyframes >= options_.interval_resting;
  const bool was_found =
      readout_.was_found || focal_length_.was_found || distortion_.was_found || principal_point_.was_found;
  return keyframes >= (was_found ? options_.interval_found : options_.interval);
}

void CameraFinding::lookAtReadout(const LookedAt& at, double longest_s, int keyframes, FoundCamera& found) {
  const std::optional<CameraEstimate> estimate = estimateReadout(at, longest_s);
  if (estimate &&
      isToChange(looking_for_readout, *estimate, at.camera.readout_s, keyframes, options_.most_keyframes, readout_)) {
    found.readout_s = std::clamp(estimate->value, -longest_s, longest_s);
  }
}

bool CameraFinding::look(const Camera& calibrated, const GlobalAdjustmentOptions& global,
                         const LocalAdjustmentOptions& local, Map& map) {
  if (calibrated.readout_s != 0) readout_.is_settled = true;
  const bool is_readout_due = isDue(readout_, ++since_readout_);
  ++since_lens_;
  const bool is_principal_point_unsettled = principal_point_.was_found && !principal_point_.is_settled;
  const bool is_lens_due = isDue(focal_length_, since_lens_) || isDue(distortion_, since_lens_) ||
                           (is_principal_point_unsettled && since_lens_ >= options_.interval_found);
  if (!options_.is_enabled || (!is_readout_due && !is_lens_due)) return false;
  const std::vector<KeyframeId> all = keyframesOf(map, map.keyframes.back().world);
  if (static_cast<int>(all.size()) < options_.fewest_keyframes) return false;
  const Camera camera = withFound(calibrated, map.found);
  const std::vector<KeyframeId> latest = latestOf(all, options_.most_keyframes);
  FoundCamera found = map.found;
  if (is_readout_due) {
    const int keyframes = std::exchange(since_readout_, 0);
    const std::optional<LookedAt> at = lookAt(camera, global, local, latest, map);
    if (at) lookAtReadout(*at, longestReadout(map, latest), keyframes, found);
  }
  if (is_lens_due) {
    const int keyframes = std::exchange(since_lens_, 0);
    const bool is_found = focal_length_.was_found || distortion_.was_found || principal_point_.was_found;
    const std::vector<KeyframeId> looked_at = is_found ? latestOf(all, options_.most_keyframes_found) : latest;
    const std::optional<LookedAt> at = lookAt(camera, global, local, looked_at, seenBy(looked_at, map));
    const FoundCamera before = found;
    if (at) lookAtLens(*at, keyframes, found);
    const bool is_lens_as_it_was = found == before;
    if (at && is_lens_as_it_was && !principal_point_.is_settled) lookAtPrincipalPoint(*at, keyframes, found);
  }
  if (++looks_ >= options_.most_looks) {
    readout_.is_settled = focal_length_.is_settled = distortion_.is_settled = principal_point_.is_settled = true;
  }
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
