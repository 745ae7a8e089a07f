#include "mapping/lens_estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/distortion_reach.h"
#include "geometry/millionths.h"

namespace edgeslam {
namespace {

constexpr int unknowns = 5;
constexpr int iterations_of_trial = 3;                    // about a map that is adjusted; more find the same
constexpr std::array<double, 2> distortion_at{0.5, 0.9};  // of the way from the centre to the farthest corner
constexpr double most_change_at_once = 0.1, most_moved_at_once_px = 20;
constexpr double most_moved = 0.05;  // of the longer side: the principal point from that of the calibration
// What errs together makes costs tell so many times as much as measurements that err by themselves.
constexpr double times_less_known = 16;
// Evidence by which a part of the lens is another one: some four standard deviations of one unknown.
constexpr double least_evidence = 9;

double longerSide(const Camera& camera) { return std::max(camera.width, camera.height); }

std::array<bool, unknowns> unknownsOf(const LensParts& parts) {
  return {parts.focal_length, parts.distortion, parts.distortion, parts.principal_point, parts.principal_point};
}

// At the two radii, by k1 and k2.
Eigen::Matrix2d movesByCoefficients(const Camera& camera) {
  Eigen::Matrix2d moves;
  for (int k = 0; k < 2; ++k) {
    const double squared = std::pow(distortion_at[static_cast<std::size_t>(k)] * farthestCorner(camera), 2);
    moves.row(k) << squared, squared * squared;
  }
  return moves;
}

}  // namespace

LensMatrix wellConditioned(const LensMatrix& information) {
  constexpr double least_own_share = 0.03;
  const LensVector sigmas = information.diagonal().cwiseSqrt().cwiseInverse();
  const LensMatrix together = sigmas.asDiagonal() * information * sigmas.asDiagonal() - LensMatrix::Identity();
  const double least = Eigen::SelfAdjointEigenSolver<LensMatrix>(together, Eigen::EigenvaluesOnly).eigenvalues()(0);
  const double times = std::min(1.0, (1 - least_own_share) / std::max(-least, 1e-9));
  LensMatrix result = times * information;
  result.diagonal() = information.diagonal();
  return result;
}

std::optional<LensEquations> lensEquations(const LookedAt& at, double least_gain, double farthest_steps) {
  LensVector step;
  step << 0.02, 0.004, 0.004, 3, 3;
  LookedAt trials = at;
  trials.adjustment.bundle.iterations = iterations_of_trial;
  const auto costOf = [&](const LensVector& change) {
    return costWith(trials, withFound(at.camera, withLens(at.camera, {}, change)));
  };
  LensEquations equations;
  LensVector bend;  // of the cost, from one side to the other
  double largest_gain = 0;
  for (int k = 0; k < unknowns; ++k) {
    const LensVector away = step(k) * LensVector::Unit(k);
    const double ahead = costOf(away), behind = costOf(-away);
    bend(k) = ahead - 2 * at.cost + behind;
    equations.gradient(k) = (ahead - behind) / (2 * step(k));
    equations.information(k, k) = bend(k) / (step(k) * step(k));
    largest_gain = std::max(
        largest_gain, 0.5 * equations.gradient(k) * equations.gradient(k) / std::abs(equations.information(k, k)));
  }
  for (int k = 1; k < unknowns && largest_gain >= least_gain; ++k) {
    for (int l = 0; l < k; ++l) {
      const LensVector away = step(k) * LensVector::Unit(k) + step(l) * LensVector::Unit(l);
      const double both = costOf(away) - 2 * at.cost + costOf(-away);
      equations.information(k, l) = equations.information(l, k) = (both - bend(k) - bend(l)) / (2 * step(k) * step(l));
    }
  }
  if (!equations.gradient.allFinite() || !equations.information.allFinite()) return std::nullopt;
  for (int k = 0; k < unknowns; ++k) {
    double& own = equations.information(k, k);
    own = std::max(own, std::abs(equations.gradient(k)) / (farthest_steps * step(k)));
  }
  if (!(equations.information.diagonal().minCoeff() > 0)) return std::nullopt;
  equations.information = wellConditioned(equations.information);
  return equations;
}

LensEstimate estimateLens(const LensEquations& equations, const LensKnowledge& known, const LensParts& free) {
  const LensMatrix calibration = known.sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  LensMatrix information = equations.information / times_less_known + calibration;
  LensVector gradient = equations.gradient / times_less_known + calibration * known.found;
  const std::array<bool, unknowns> is_free = unknownsOf(free);
  for (int k = 0; k < unknowns; ++k) {
    if (is_free[static_cast<std::size_t>(k)]) continue;
    information.row(k).setZero();
    information.col(k).setZero();
    information(k, k) = 1;
    gradient(k) = 0;
  }
  const Eigen::LLT<LensMatrix> factor(information);
  LensEstimate estimate;
  estimate.change = -factor.solve(gradient);
  estimate.sigma = factor.solve(LensMatrix::Identity()).diagonal().cwiseSqrt();
  estimate.evidence = -0.5 * gradient.dot(estimate.change);
  estimate.gain =
      -equations.gradient.dot(estimate.change) - 0.5 * estimate.change.dot(equations.information * estimate.change);
  return estimate;
}

LensParts toldOfLens(const LensEquations& equations, const LensKnowledge& known, const LensParts& looked_for,
                     const LensParts& found) {
  LensParts told = looked_for;
  for (;;) {
    const double evidence = estimateLens(equations, known, told).evidence;
    double least = least_evidence;
    LensParts without = told;
    for (bool LensParts::*part : {&LensParts::focal_length, &LensParts::distortion, &LensParts::principal_point}) {
      if (!(told.*part) || found.*part) continue;
      LensParts less = told;
      less.*part = false;
      const double added = evidence - estimateLens(equations, known, less).evidence;
      if (added >= least) continue;
      least = added;
      without = less;
    }
    if (least == least_evidence) return told;
    told = without;
  }
}

LensVector sigmaOfCalibration(const Camera& camera) {
  LensVector sigma;
  sigma << 0.04, 0.01, 0.01, 0.0125 * longerSide(camera), 0.0125 * longerSide(camera);
  return sigma;
}

LensVector sigmaOfPresumed(const Camera& camera) {
  LensVector sigma;
  sigma << 0.3, 0.03, 0.03, 0.015 * longerSide(camera), 0.015 * longerSide(camera);
  return sigma;
}

LensVector lensOf(const Camera& camera, const FoundCamera& found) {
  LensVector lens;
  lens << std::log(found.focal_scale), movesByCoefficients(camera) * Eigen::Vector2d(found.radial[0], found.radial[1]),
      Eigen::Vector2d(found.principal_point[0], found.principal_point[1]);
  return lens;
}

FoundCamera withLens(const Camera& camera, const FoundCamera& found, const LensVector& change,
                     double most_focal_change) {
  FoundCamera with = found;
  const double logarithm = std::clamp(std::log(found.focal_scale) + change(0), -most_focal_change, most_focal_change);
  with.focal_scale = inMillionths(std::exp(logarithm));
  const Eigen::Vector2d radial = movesByCoefficients(camera).inverse() * change.segment<2>(1);
  const double farthest = most_moved * longerSide(camera);
  for (int k = 0; k < 2; ++k) {
    const auto index = static_cast<std::size_t>(k);
    with.radial[index] = inMillionths(found.radial[index] + radial(k));
    with.principal_point[index] =
        inMillionths(std::clamp(found.principal_point[index] + change(3 + k), -farthest, farthest));
  }
  return with;
}

LensVector worthwhile(const LookedAt& at, const LensEquations& equations, LensVector change) {
  const double times_too_far = std::max(change.head<3>().cwiseAbs().maxCoeff() / most_change_at_once,
                                        change.tail<2>().cwiseAbs().maxCoeff() / most_moved_at_once_px);
  if (times_too_far > 1) change /= times_too_far;
  const auto with = [&](double share) { return withFound(at.camera, withLens(at.camera, {}, share * change)); };
  const auto expected_gain = [&](double share) {
    const LensVector part = share * change;
    return -equations.gradient.dot(part) - 0.5 * part.dot(equations.information * part);
  };
  return worthwhileShare(at, with, expected_gain) * change;
}

}  // namespace edgeslam
