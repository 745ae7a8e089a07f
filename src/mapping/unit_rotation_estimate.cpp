#include "mapping/unit_rotation_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/squared.h"
#include "inertia/turn_fit.h"

namespace edgeslam {
namespace {

// Long against the errors of single poses, short against the time in which a hand turns to and fro.
constexpr double turned_for_s = 0.2;
constexpr double given_sigma = radians(2.0);  // of a rotation that was measured by eye or taken from a drawing
constexpr double least_offset_change_s = 4e-3, offset_sigmas = 5;

// The offset was held so far: one that is another one now would go into the rotation.
bool contradictsOffset(const TurnFit& fit, double offset_s) {
  const double sigma_s = std::sqrt(fit.covariance(6, 6));
  return !(std::abs(fit.parameters.offset_s - offset_s) < std::max(least_offset_change_s, offset_sigmas * sigma_s));
}

}  // namespace

std::optional<UnitRotationEstimate> estimateUnitRotation(const std::vector<PosedCamera>& frames,
                                                         const std::vector<InertialSample>& samples,
                                                         const InertialUnit& unit, const Eigen::Quaterniond& near) {
  const std::vector<CameraTurn> turns = cameraTurns(frames, turned_for_s);
  if (turns.size() < fewest_turns || samples.empty()) return std::nullopt;
  const double offset_s = 1e-9 * static_cast<double>(unit.offset_ns);
  const std::optional<TurnFit> fit =
      fitTurns(turns, samples, {near, Eigen::Vector3d::Zero(), offset_s}, unit.rate_walk);
  if (!fit || !fit->covariance.allFinite() || contradictsOffset(*fit, offset_s)) return std::nullopt;
  const Eigen::Matrix3d measured = fit->covariance.topLeftCorner<3, 3>();
  const Eigen::Vector3d change =
      rotationLog((unit.imu_T_camera.rotation.conjugate() * fit->parameters.imu_R_camera).normalized());
  // As it is measured, beside what is given.
  const Eigen::Matrix3d given = squared(given_sigma) * Eigen::Matrix3d::Identity();
  const Eigen::LLT<Eigen::Matrix3d> sum(given + measured);
  if (sum.info() != Eigen::Success) return std::nullopt;
  UnitRotationEstimate estimate;
  estimate.change = given * sum.solve(change);
  estimate.covariance = given - given * sum.solve(given);
  estimate.seconds = fit->seconds;
  return estimate;
}

}  // namespace edgeslam
