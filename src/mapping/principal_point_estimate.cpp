#include "mapping/principal_point_estimate.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr int iterations_of_trial = 3;  // about a map that is adjusted; more find the same
constexpr double step_px = 3;

Camera withMoved(Camera camera, const Eigen::Vector2d& by_px) {
  camera.cx += by_px.x();
  camera.cy += by_px.y();
  return camera;
}

}  // namespace

std::optional<PrincipalPointEstimate> estimatePrincipalPoint(const LookedAt& at, double least_gain) {
  LookedAt trials = at;
  trials.adjustment.bundle.iterations = iterations_of_trial;
  const auto cost = [&](int x, int y) { return costWith(trials, withMoved(at.camera, {x * step_px, y * step_px})); };
  const double right = cost(1, 0), left = cost(-1, 0), below = cost(0, 1), above = cost(0, -1);
  const Eigen::Vector2d gradient = Eigen::Vector2d(right - left, below - above) / (2 * step_px);
  const Eigen::Vector2d curvature =
      Eigen::Vector2d(right - 2 * at.cost + left, below - 2 * at.cost + above) / (step_px * step_px);
  // Four trials more only where these say that there is something to gain.
  if (0.5 * (gradient.array().square() / curvature.array()).sum() < least_gain) return std::nullopt;
  const double across = (cost(1, 1) + cost(-1, -1) - cost(1, -1) - cost(-1, 1)) / (4 * step_px * step_px);
  Eigen::Matrix2d information;
  information << curvature.x(), across, across, curvature.y();
  if (!gradient.allFinite() || !information.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> directions(information);
  const double least = directions.eigenvalues()(0);
  if (!(least > 0)) return std::nullopt;
  PrincipalPointEstimate estimate;
  estimate.change = -directions.eigenvectors() * directions.eigenvalues().cwiseInverse().asDiagonal() *
                    directions.eigenvectors().transpose() * gradient;
  estimate.sigma = 1 / std::sqrt(least);
  estimate.gain = -0.5 * gradient.dot(estimate.change);
  if (estimate.gain > at.cost) return std::nullopt;  // it is no parabola
  return estimate;
}

Eigen::Vector2d worthwhile(const LookedAt& at, const PrincipalPointEstimate& estimate) {
  constexpr double most_change_at_once = 10;  // [px]
  const double most = std::min(1.0, most_change_at_once / estimate.change.norm());
  const auto with = [&](double share) { return withMoved(at.camera, share * most * estimate.change); };
  const auto expected_gain = [&](double share) {
    const double part = share * most;
    return (2 * part - part * part) * estimate.gain;
  };
  return worthwhileShare(at, with, expected_gain) * most * estimate.change;
}

}  // namespace edgeslam
