#include "places/similarity_estimation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>

#include "adjustment/reprojection.h"

namespace edgeslam {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Matrix37d = Eigen::Matrix<double, 3, 7>;
using Matrix27d = Eigen::Matrix<double, 2, 7>;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Right-hand update [translation; rotation vector; logarithm of the scale].
Similarity retract(const Similarity& similarity, const Vector7d& update) {
  const Similarity step{std::exp(update(6)), rotationExp(update.segment<3>(3)), update.head<3>()};
  return similarity * step;
}

// Whitened residuals and their derivatives by the update: across and along the edge in the current image, in the
// candidate's, and the distance.
struct Residuals {
  Eigen::Vector2d current = Eigen::Vector2d::Zero(), candidate = Eigen::Vector2d::Zero();
  double depth = 0;
  Matrix27d current_by_update, candidate_by_update;
  Eigen::Matrix<double, 1, 7> depth_by_update;
};

bool evaluate(const Camera& camera, const PlaceCorrespondence& c, const Similarity& current_S_candidate,
              bool derivatives, Residuals& residuals) {
  const Eigen::Vector3d in_current = current_S_candidate * c.candidate_point;
  Matrix23d by_point;
  if (!pointResidual(camera, {c.in_current.pixel, whitening(c.in_current)}, in_current, residuals.current,
                     derivatives ? &by_point : nullptr)) {
    return false;
  }
  Matrix37d point_by_update;
  if (derivatives) {
    const Eigen::Matrix3d linear = current_S_candidate.scale * current_S_candidate.rotation.toRotationMatrix();
    point_by_update << linear, -linear * skew(c.candidate_point), linear * c.candidate_point;
    residuals.current_by_update = by_point * point_by_update;
  }
  if (!c.paired) return true;
  residuals.depth = std::log(in_current.norm() / c.current_point.norm()) / c.depth_deviation;
  const Eigen::Vector3d in_candidate = current_S_candidate.inverse() * c.current_point;
  Matrix23d by_other;
  if (!pointResidual(camera, {c.in_candidate.pixel, whitening(c.in_candidate)}, in_candidate, residuals.candidate,
                     derivatives ? &by_other : nullptr)) {
    return false;
  }
  if (derivatives) {
    residuals.depth_by_update =
        in_current.transpose() * point_by_update / (in_current.squaredNorm() * c.depth_deviation);
    Matrix37d other_by_update;
    other_by_update << -Eigen::Matrix3d::Identity(), skew(in_candidate), -in_candidate;
    residuals.candidate_by_update = by_other * other_by_update;
  }
  return true;
}

// All three errors agree to this many sigmas; measured on the largest.
double largest(const PlaceCorrespondence& c, const Residuals& residuals) {
  const double seen = residuals.current.norm();
  return c.paired ? std::max({seen, residuals.candidate.norm(), std::abs(residuals.depth)}) : seen;
}

int countInliers(const Camera& camera, const std::vector<PlaceCorrespondence>& pairs, const Similarity& similarity,
                 double outlier, std::vector<char>& inliers) {
  inliers.assign(pairs.size(), 0);
  int count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!(correspondenceError(camera, pairs[i], similarity) < outlier)) continue;
    inliers[i] = 1;
    ++count;
  }
  return count;
}

}  // namespace

double correspondenceError(const Camera& camera, const PlaceCorrespondence& correspondence,
                           const Similarity& current_S_candidate) {
  Residuals residuals;
  if (!evaluate(camera, correspondence, current_S_candidate, false, residuals)) return infinity;
  return largest(correspondence, residuals);
}

Similarity refineSimilarity(const Camera& camera, const std::vector<PlaceCorrespondence>& correspondences,
                            const Similarity& start, double huber, int iterations) {
  const auto normalEquations = [&](const Similarity& at, Matrix7d& information, Vector7d& gradient) {
    information.setZero();
    gradient.setZero();
    double cost = 0;
    Residuals r;
    for (const PlaceCorrespondence& c : correspondences) {
      if (!evaluate(camera, c, at, true, r)) {
        cost += huberLoss(100.0 * 100.0, huber);
        continue;
      }
      const auto add = [&](const auto& residual, const auto& by_update) {
        const double norm = residual.norm(), weight = huberWeight(norm, huber);
        information.noalias() += weight * by_update.transpose() * by_update;
        gradient.noalias() += weight * by_update.transpose() * residual;
        cost += huberLoss(norm * norm, huber);
      };
      add(r.current, r.current_by_update);
      if (!c.paired) continue;
      add(r.candidate, r.candidate_by_update);
      add(Eigen::Matrix<double, 1, 1>(r.depth), r.depth_by_update);
    }
    return cost;
  };
  Similarity best = start;
  Matrix7d information, trial_information;
  Vector7d gradient, trial_gradient;
  double cost = normalEquations(best, information, gradient), damping = 1e-4;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Matrix7d damped = information;
    damped.diagonal() += damping * information.diagonal() + Vector7d::Constant(1e-9);
    const Vector7d step = -damped.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    const Similarity trial = retract(best, step);
    const double trial_cost = normalEquations(trial, trial_information, trial_gradient);
    if (!(trial_cost < cost)) {
      damping *= 10;
      if (damping > 1e3) break;
      continue;
    }
    const bool settled = cost - trial_cost < 1e-6 * cost;
    best = trial;
    cost = trial_cost;
    information = trial_information;
    gradient = trial_gradient;
    damping = std::max(1e-7, damping * 0.1);
    if (settled) break;
  }
  return best;
}

SimilarityEstimate estimateSimilarity(const Camera& camera, const std::vector<PlaceCorrespondence>& pairs,
                                      double outlier, int fewest_inliers, int iterations, std::uint64_t seed) {
  assert(std::all_of(pairs.begin(), pairs.end(), [](const PlaceCorrespondence& pair) { return pair.paired; }));
  SimilarityEstimate estimate;
  const std::size_t count = pairs.size();
  if (count < 3 || static_cast<int>(count) < fewest_inliers) return estimate;
  std::mt19937_64 random(seed);
  std::vector<Eigen::Vector3d> from(3), to(3);
  std::vector<char> inliers;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const std::size_t a = random() % count, b = random() % count, c = random() % count;
    if (a == b || b == c || a == c) continue;
    std::size_t k = 0;
    for (const std::size_t i : {a, b, c}) {
      from[k] = pairs[i].candidate_point;
      to[k++] = pairs[i].current_point;
    }
    // Three points near one line say nothing about the turn around it.
    const Eigen::Vector3d u = from[1] - from[0], v = from[2] - from[0];
    if (u.cross(v).norm() < 0.05 * u.norm() * v.norm()) continue;
    const Similarity similarity = alignHorn(from, to);
    const int agreeing = countInliers(camera, pairs, similarity, outlier, inliers);
    if (agreeing <= estimate.inlier_count) continue;
    estimate.inlier_count = agreeing;
    estimate.current_S_candidate = similarity;
    estimate.inliers = inliers;
  }
  // The best sample's inliers move the similarity, which gains others.
  for (int round = 0; round < 4 && estimate.inlier_count >= 3; ++round) {
    std::vector<PlaceCorrespondence> agreeing;
    for (std::size_t i = 0; i < count; ++i) {
      if (estimate.inliers[i]) agreeing.push_back(pairs[i]);
    }
    const Similarity refined = refineSimilarity(camera, agreeing, estimate.current_S_candidate, outlier / 2, 10);
    const int now = countInliers(camera, pairs, refined, outlier, inliers);
    if (now < estimate.inlier_count) break;
    const bool gained = now > estimate.inlier_count;
    estimate.current_S_candidate = refined;
    estimate.inliers = inliers;
    estimate.inlier_count = now;
    if (!gained) break;
  }
  estimate.found = estimate.inlier_count >= fewest_inliers;
  return estimate;
}

}  // namespace edgeslam
