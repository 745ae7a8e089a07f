#include "mapping/camera_looks.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double farthest_believed = 0.25;  // change of the lens: beyond it the trials do not say
constexpr double times_less_known = 4;      // what errs together makes estimates err so many times as far as they say
constexpr Looking looking_for_focal_length_beside_distortion{0.005, 0.03, 3, 3, 0.02, 0.01, 0.003, 0.01};
constexpr double alike = 0.25;        // estimates that differ by less of their value agree, too
constexpr double beyond_doubt = 8;    // standard deviations; only without a least change
constexpr double least_share = 0.02;  // of the cost: with the right lens some other one explains less ...
constexpr double least_gain = 2;      // ... and of the cost itself: two standard deviations
constexpr double clearly_more = 2;    // by itself: of the two a focal length is calibrated rather than a distortion ...
constexpr double most_of_distortion = 0.04;  // ... which looks like so much of a focal length

// Of the principal point [px].
struct LookingForPrincipalPoint {
  double least_sigma = 0.5;             // none is known better
  double well_known = 2;                // standard deviation with which a look counts, ...
  double least_sigmas = 3;              // ... if the change is so many of them ...
  double least_share = 0.025;           // ... and explains so much of the cost
  int agreeing_looks = 3;               // if so many looks in a row say so, within as many standard deviations, ...
  double beyond_doubt = 0.1;            // ... or one that explains so much of the cost, it is not as presumed
  double little = 1, too_little = 0.3;  // as above
};
constexpr LookingForPrincipalPoint looking_for_principal_point;

double honestSigma(const Looking& looking, const CameraEstimate& estimate) {
  return std::hypot(times_less_known * estimate.sigma, looking.least_sigma);
}

// A change that is clearly one.
bool saysSo(const Looking& looking, const CameraEstimate& change) {
  return std::abs(change.value) > std::max(looking.least, looking.least_sigmas * honestSigma(looking, change));
}

}  // namespace

CameraEstimate focalLengthOf(const LensEstimate& estimate) {
  return {estimate.change(0), std::sqrt(estimate.covariance(0, 0))};
}

CameraEstimate distortionOf(const LensEstimate& estimate) {
  return {std::sqrt(0.5 * estimate.change.tail<2>().squaredNorm()),
          std::sqrt(0.5 * estimate.covariance.diagonal().tail<2>().sum())};
}

bool isToChange(const Looking& looking, const CameraEstimate& estimate, double now, int keyframes, int enough,
                CameraLooks& looks, bool is_far_off) {
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

double enoughGain(double cost) {
  return std::max(least_share * cost, times_less_known * times_less_known * least_gain);
}

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

bool isToChange(const PrincipalPointEstimate& estimate, double cost, int keyframes, int enough,
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
  const bool says_so = sigma < looking.well_known && length > far && estimate.gain > enoughGainOfPrincipalPoint(cost);
  const bool agrees = looks.agreeing > 0 && (estimate.change - looks.last).norm() < far;
  looks.agreeing = !says_so ? 0 : agrees ? looks.agreeing + 1 : 1;
  looks.last = estimate.change;
  const bool is_beyond_doubt = says_so && estimate.gain > looking.beyond_doubt * cost;
  looks.was_found = is_beyond_doubt || looks.agreeing >= looking.agreeing_looks;
  return looks.was_found;
}

}  // namespace edgeslam
