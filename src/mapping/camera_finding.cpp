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
constexpr double farthest_steps = 5;  // of trials of a lens that is presumed
constexpr double least_part = 0.4;    // of a change, where it is the first one
constexpr double hardly_any = 0.25;   // of a gain that counts: with others it does not come to more

std::vector<KeyframeId> latestOf(std::vector<KeyframeId> keyframes, int most) {
  if (static_cast<int>(keyframes.size()) > most) keyframes.erase(keyframes.begin(), keyframes.end() - most);
  return keyframes;
}

}  // namespace

void CameraFinding::lookAtLens(const LookedAt& at, int keyframes, FoundCamera& found) {
  const bool is_presumed = options_.lens_is_presumed;
  const auto equations = lensEquations(at, any(lens_.found) ? 0 : hardly_any * enoughGain(at.cost),
                                       is_presumed ? farthest_steps : infinity);
  if (!equations) return;
  const LensKnowledge known{is_presumed ? sigmaOfPresumed(at.camera) : sigmaOfCalibration(at.camera),
                            lensOf(at.camera, found)};
  // Beside a focal length that is far off the trials tell little of the axis.
  const LensParts looked_for{true, true, !is_presumed || any(lens_.found)};
  const LensParts parts = toldOfLens(*equations, known, looked_for, lens_.found);
  LensParts told = toldByLooks(parts, estimateLens(*equations, known, parts).evidence, lens_);
  // Of a lens that is presumed neither is likely to be right, and the one would take the blame for the other.
  if (is_presumed && any(told)) told.focal_length = told.distortion = true;
  const LensEstimate estimate = estimateLens(*equations, known, any(told) ? told : looked_for);
  if (!is_presumed && estimate.gain > at.cost) return;  // it is no parabola
  if (!isToChange(estimate, told, at.cost, keyframes, options_.most_keyframes, lens_)) return;
  const LensVector change = worthwhile(at, *equations, estimate.change);
  if (change.isZero(0)) return;
  const bool is_hardly_any = change.norm() < least_part * estimate.change.norm();
  if (is_hardly_any && !is_presumed && !any(lens_.found)) return;  // nor is that one
  lens_.found = told;
  found = withLens(at.camera, found, change, is_presumed ? most_change_of_presumed : most_change_of_calibrated);
}

bool CameraFinding::readoutIsSettled() const { return !options_.is_enabled || readout_.is_settled || readout_.rests; }

bool CameraFinding::lensIsSettled() const { return !options_.is_enabled || lens_.is_settled || lens_.rests; }

bool CameraFinding::isDue(bool is_settled, bool rests, int keyframes) const {
  if (is_settled) return false;
  if (rests) return keyframes >= options_.interval_resting;
  const bool was_found = readout_.was_found || any(lens_.found);
  return keyframes >= (was_found ? options_.interval_found : options_.interval);
}

void CameraFinding::lookAtReadout(const LookedAt& at, double longest_s, int keyframes, FoundCamera& found) {
  const std::optional<CameraEstimate> estimate = estimateReadout(at, longest_s);
  if (estimate && isToChange(*estimate, at.camera.readout_s, keyframes, options_.most_keyframes, readout_)) {
    found.readout_s = std::clamp(estimate->value, -longest_s, longest_s);
  }
}

bool CameraFinding::look(const Camera& calibrated, const GlobalAdjustmentOptions& global,
                         const LocalAdjustmentOptions& local, Map& map) {
  if (calibrated.readout_s != 0) readout_.is_settled = true;
  const bool is_readout_due = isDue(readout_.is_settled, readout_.rests, ++since_readout_);
  const bool is_lens_due = isDue(lens_.is_settled, lens_.rests, ++since_lens_);
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
  const bool waits = isUnderWay(readout_) && lens_waited_ < options_.longest_wait;
  lens_waited_ = is_lens_due && waits ? lens_waited_ + 1 : 0;
  if (is_lens_due && !waits) {
    const int keyframes = std::exchange(since_lens_, 0);
    const std::vector<KeyframeId> looked_at = any(lens_.found) ? latestOf(all, options_.most_keyframes_found) : latest;
    const std::optional<LookedAt> at = lookAt(camera, global, local, looked_at, seenBy(looked_at, map));
    if (at) lookAtLens(*at, keyframes, found);
  }
  if (is_readout_due || (is_lens_due && !waits)) ++looks_;
  if (looks_ >= options_.most_looks) readout_.is_settled = lens_.is_settled = true;
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
