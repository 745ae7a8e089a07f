#include "mapping/camera_looks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace edgeslam {
namespace {

// Of the readout [s].
constexpr double times_less_known = 4;    // what errs together makes estimates err so many times as far as they say
constexpr double least_sigma_s = 0.0005;  // none is known better
constexpr double least_sigmas = 3;        // over so many standard deviations it is not as presumed, ...
constexpr int agreeing_looks = 2;         // ... if so many looks in a row say so, ...
constexpr double beyond_doubt = 8;        // ... or one by so many standard deviations
constexpr double agreement_s = 0.05;      // estimates that differ by less agree, ...
constexpr double alike = 0.25;            // ... and by less of their value
constexpr double little_s = 0.001;        // a change by less is none, for what has come to stay, ...
constexpr double too_little_s = 0.0003;   // ... and by less the map is not adjusted
constexpr double well_known_s = 0.002;    // standard deviation with which looks that find nothing count

// Of the lens.
constexpr double evidence_beyond_doubt = 20;  // one look that says so is enough
constexpr double least_share = 0.02;          // of the cost: with the right lens some other one explains less ...
constexpr double least_gain = 32;             // ... and of a small cost less than this
constexpr double little_sigmas = 0.5;         // a change by fewer standard deviations is none
// Standard deviations of focal length and distortion with which looks that find nothing count.
constexpr double well_known = 0.01, well_known_distortion = 0.004;

}  // namespace

bool isToChange(const CameraEstimate& readout, double now_s, int keyframes, int enough, ReadoutLooks& looks) {
  const double change_s = readout.value - now_s;
  if (looks.was_found) {
    looks.steady = std::abs(change_s) < little_s ? looks.steady + keyframes : 0;
    looks.is_settled = looks.steady >= enough;
    return std::abs(change_s) > too_little_s;
  }
  const double sigma_s = std::hypot(times_less_known * readout.sigma, least_sigma_s);
  const bool says_so = std::abs(change_s) > least_sigmas * sigma_s;
  const bool is_alike = std::abs(change_s - looks.last_s) < std::max(agreement_s, alike * std::abs(change_s));
  const bool agrees = looks.agreeing > 0 && change_s * looks.last_s > 0 && is_alike;
  looks.agreeing = !says_so ? 0 : agrees ? looks.agreeing + 1 : 1;
  looks.last_s = change_s;
  looks.steady = !says_so && sigma_s < well_known_s ? looks.steady + keyframes : 0;
  looks.rests = looks.steady >= enough;
  looks.was_found = std::abs(change_s) > beyond_doubt * sigma_s || looks.agreeing >= agreeing_looks;
  return looks.was_found;
}

bool isUnderWay(const ReadoutLooks& looks) {
  if (looks.is_settled) return false;
  return looks.was_found ? looks.steady == 0 : looks.agreeing > 0;
}

LensParts toldByLooks(const LensParts& parts, double evidence, LensLooks& looks) {
  const LensParts before = std::exchange(looks.told, parts);
  if (evidence > evidence_beyond_doubt) return parts;
  return {looks.found.focal_length || (parts.focal_length && before.focal_length),
          looks.found.distortion || (parts.distortion && before.distortion),
          looks.found.principal_point || (parts.principal_point && before.principal_point)};
}

bool isToChange(const LensEstimate& estimate, const LensParts& told, double cost, int keyframes, int enough,
                LensLooks& looks) {
  if (any(looks.found)) {
    const bool is_little = estimate.change.cwiseQuotient(estimate.sigma).cwiseAbs().maxCoeff() < little_sigmas;
    looks.steady = is_little ? looks.steady + keyframes : 0;
    looks.is_settled = looks.steady >= enough;
    return !is_little;
  }
  const bool is_told = any(told) && estimate.gain > enoughGain(cost);
  const bool is_well_known =
      estimate.sigma(0) < well_known && estimate.sigma.segment<2>(1).maxCoeff() < well_known_distortion;
  looks.steady = !is_told && is_well_known ? looks.steady + keyframes : 0;
  looks.rests = looks.steady >= enough;
  return is_told;
}

double enoughGain(double cost) { return std::max(least_share * cost, least_gain); }

}  // namespace edgeslam
