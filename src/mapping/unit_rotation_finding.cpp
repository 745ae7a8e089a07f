#include "mapping/unit_rotation_finding.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "inertia/found_time_offset.h"
#include "inertia/samples_since.h"

namespace edgeslam {
namespace {

constexpr std::int64_t look_interval_ns = 1'000'000'000;
constexpr double shortest_looked_at_s = 5;
constexpr double least_change = radians(0.6);  // less is no harm: it is as given
constexpr double least_sigmas = 5.6;           // of what is another one: of a vector as rare as 5 of a number
constexpr int agreeing_looks = 3;              // in a row, ...
constexpr double agreement = radians(0.3);     // ... within this, or ...
constexpr double alike_changes = 0.25;         // ... this of what they say
constexpr double bending = radians(0.3);       // change that tells in the map
constexpr double too_little = radians(0.1);    // change of what was found

// As a multiple of what is known of it.
double sigmasOf(const Eigen::Vector3d& change, const Eigen::Matrix3d& covariance) {
  return std::sqrt(change.dot(covariance.llt().solve(change)));
}

double worstSigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()(2));
}

}  // namespace

bool UnitRotationFinding::look(const std::vector<PosedCamera>& frames, const std::vector<InertialSample>& samples,
                               std::int64_t offset_ns) {
  if (frames.empty() || frames.back().time_ns < looked_ns_ + look_interval_ns) return false;
  looked_ns_ = frames.back().time_ns;
  unit_.offset_ns = offset_ns;
  const Eigen::Quaterniond& given = unit_.imu_T_camera.rotation;
  const std::int64_t begin_ns = frames.front().time_ns + offset_ns - 2 * farthest_time_offset_ns;
  const std::optional<UnitRotationEstimate> estimate =
      estimateUnitRotation(frames, samplesSince(samples, begin_ns), unit_, found_ ? found_->imu_R_camera : given);
  if (!estimate || estimate->seconds < shortest_looked_at_s || !isToChange(*estimate)) return false;
  found_ = FoundUnitRotation{(given * rotationExp(estimate->change)).normalized(), worstSigma(estimate->covariance)};
  bends_map_ = (estimate->change - taken_).norm() > bending;
  taken_ = estimate->change;
  return true;
}

bool UnitRotationFinding::isToChange(const UnitRotationEstimate& estimate) {
  const Eigen::Vector3d change = estimate.change - taken_;
  if (found_) {
    return change.norm() > too_little && sigmasOf(change, estimate.covariance) > 1 &&
           worstSigma(estimate.covariance) < found_->sigma_rad && estimate.change.norm() < farthest_unit_rotation;
  }
  const bool says_so = change.norm() > least_change && sigmasOf(change, estimate.covariance) > least_sigmas;
  const bool agrees = agreeing_ > 0 && (change - last_).norm() < std::max(agreement, alike_changes * change.norm());
  agreeing_ = !says_so ? 0 : agrees ? agreeing_ + 1 : 1;
  last_ = change;
  if (agreeing_ < agreeing_looks) return false;
  too_far_ = change.norm() > farthest_unit_rotation ? change.norm() : 0;
  return too_far_ == 0;
}

}  // namespace edgeslam
