#include "mapping/lens_estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/distortion_reach.h"
#include "geometry/millionths.h"

namespace edgeslam {
namespace {

constexpr int iterations_of_trial = 3;          // about a map that is adjusted; more find the same
constexpr double distortion_at[] = {0.5, 0.9};  // of the way from the centre to the farthest corner
constexpr double most_change_at_once = 0.1;

}  // namespace

Eigen::Matrix3d wellConditioned(const Eigen::Matrix3d& information) {
  constexpr double least_own_share = 0.03;
  const Eigen::Vector3d sigmas = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d together =
      sigmas.asDiagonal() * information * sigmas.asDiagonal() - Eigen::Matrix3d::Identity();
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(together, Eigen::EigenvaluesOnly).eigenvalues()(0);
  const double times = std::min(1.0, (1 - least_own_share) / std::max(-least, 1e-9));
  Eigen::Matrix3d result = times * information;
  result.diagonal() = information.diagonal();
  return result;
}

std::optional<LensEquations> lensEquations(const LookedAt& at, double least_gain, double farthest_steps) {
  const Eigen::Vector3d step(0.02, 0.004, 0.004);
  LookedAt trials = at;
  trials.adjustment.bundle.iterations = iterations_of_trial;
  const auto costOf = [&](int k, double times_k, int l, double times_l) {
    const Eigen::Vector3d change =
        times_k * step(k) * Eigen::Vector3d::Unit(k) + times_l * step(l) * Eigen::Vector3d::Unit(l);
    return costWith(trials, withFound(at.camera, withLens(at.camera, {}, change)));
  };
  LensEquations equations;
  double largest_gain = 0;
  for (int k = 0; k < 3; ++k) {
    const double ahead = costOf(k, 1, k, 0), behind = costOf(k, -1, k, 0);
    equations.gradient(k) = (ahead - behind) / (2 * step(k));
    equations.information(k, k) = (ahead - 2 * at.cost + behind) / (step(k) * step(k));
    largest_gain = std::max(
        largest_gain, 0.5 * equations.gradient(k) * equations.gradient(k) / std::abs(equations.information(k, k)));
  }
  for (int k = 1; k < 3 && largest_gain >= least_gain; ++k) {
    for (int l = 0; l < k; ++l) {
      const double alike = costOf(k, 1, l, 1) + costOf(k, -1, l, -1);
      const double opposite = costOf(k, 1, l, -1) + costOf(k, -1, l, 1);
      equations.information(k, l) = equations.information(l, k) = (alike - opposite) / (4 * step(k) * step(l));
    }
  }
  if (!equations.gradient.allFinite() || !equations.information.allFinite()) return std::nullopt;
  for (int k = 0; k < 3; ++k) {
    double& own = equations.information(k, k);
    own = std::max(own, std::abs(equations.gradient(k)) / (farthest_steps * step(k)));
  }
  if (!(equations.information.diagonal().minCoeff() > 0)) return std::nullopt;
  equations.information = wellConditioned(equations.information);
  return equations;
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

FoundCamera withLens(const Camera& camera, const FoundCamera& found, const Eigen::Vector3d& change,
                     double most_focal_change) {
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

Eigen::Vector3d worthwhile(const LookedAt& at, const LensEquations& equations, Eigen::Vector3d change) {
  const double largest = change.cwiseAbs().maxCoeff();
  if (largest > most_change_at_once) change *= most_change_at_once / largest;
  const auto with = [&](double share) { return withFound(at.camera, withLens(at.camera, {}, share * change)); };
  const auto expected_gain = [&](double share) {
    const Eigen::Vector3d part = share * change;
    return -equations.gradient.dot(part) - 0.5 * part.dot(equations.information * part);
  };
  return worthwhileShare(at, with, expected_gain) * change;
}

}  // namespace edgeslam
