#include "mapping/camera_finding.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "geometry/millionths.h"
#include "map/worlds.h"
#include "mapping/rays_anew.h"
#include "mapping/readout_estimate.h"

namespace edgeslam {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double most_change_of_calibrated = 0.25, most_change_of_presumed = 0.7;  // logarithm of the focal lengths
constexpr double farthest_steps = 5;   // of trials of a lens that is presumed
constexpr double far_off_share = 0.2;  // of the cost: a lens that explains so much is far off; only whereto is known
constexpr double hardly_any = 0.25;    // of a gain that counts: with others it does not come to more
constexpr double most_change_of_principal_point = 0.05;  // of the longer side, over the calibration's

std::vector<KeyframeId> latestOf(std::vector<KeyframeId> keyframes, int most) {
  if (static_cast<int>(keyframes.size()) > most) keyframes.erase(keyframes.begin(), keyframes.end() - most);
  return keyframes;
}

}  // namespace

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
  const double least_gain = principal_point_.was_found ? 0 : hardly_any * enoughGainOfPrincipalPoint(at.cost);
  const std::optional<PrincipalPointEstimate> estimate = estimatePrincipalPoint(at, least_gain);
  if (!estimate) {
    principal_point_.agreeing = 0;
    return;
  }
  if (!isToChange(*estimate, at.cost, keyframes, options_.most_keyframes, principal_point_)) return;
  const Eigen::Vector2d change = worthwhile(at, *estimate);
  const double farthest = most_change_of_principal_point * std::max(at.camera.width, at.camera.height);
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
