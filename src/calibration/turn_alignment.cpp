#include "calibration/turn_alignment.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "geometry/median.h"
#include "inertia/gyroscope_turns.h"

namespace edgeslam {
namespace {

constexpr double offset_step_s = 0.01;

// Mean rates over the same time, each in its own frame [rad/s].
struct Rates {
  Eigen::Vector3d camera, gyroscope;
};

std::vector<Rates> ratesOf(const std::vector<CameraTurn>& turns, const GyroscopeTurns& gyroscope, double offset_s) {
  const std::int64_t offset_ns = std::llround(offset_s * 1e9);
  std::vector<Rates> rates;
  for (const CameraTurn& turn : turns) {
    const std::optional<GyroscopeTurn> felt = gyroscope.between(turn.from_ns + offset_ns, turn.to_ns + offset_ns);
    if (!felt) continue;
    const double seconds = secondsOf(turn);
    rates.push_back({rotationLog(turn.rotation) / seconds, rotationLog(felt->rotation) / seconds});
  }
  return rates;
}

// Without frames that were posed wrongly: they turned faster or slower than the gyroscope did, however that sits.
std::vector<Rates> withoutOutliers(const std::vector<Rates>& all) {
  constexpr double most_medians = 6;
  const auto difference = [](const Rates& both) { return std::abs(both.camera.norm() - both.gyroscope.norm()); };
  std::vector<double> differences;
  differences.reserve(all.size());
  for (const Rates& both : all) differences.push_back(difference(both));
  const double bound = most_medians * upperMedian(std::move(differences));
  std::vector<Rates> kept;
  std::copy_if(all.begin(), all.end(), std::back_inserter(kept),
               [&](const Rates& both) { return difference(both) <= bound; });
  return kept;
}

Rates meanOf(const std::vector<Rates>& rates) {
  Rates mean{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const Rates& both : rates) {
    mean.camera += both.camera;
    mean.gyroscope += both.gyroscope;
  }
  mean.camera /= static_cast<double>(rates.size());
  mean.gyroscope /= static_cast<double>(rates.size());
  return mean;
}

// A bias is the same throughout, so that rates are compared about their means.
TurnAlignment alignedRates(const std::vector<Rates>& rates, double offset_s) {
  TurnAlignment alignment;
  alignment.turns = rates.size();
  alignment.offset_s = offset_s;
  const Rates mean = meanOf(rates);
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();
  double squares = 0;
  for (const Rates& both : rates) {
    const Eigen::Vector3d camera = both.camera - mean.camera, gyroscope = both.gyroscope - mean.gyroscope;
    common += gyroscope * camera.transpose();
    squares += camera.squaredNorm() + gyroscope.squaredNorm();
  }
  const double count = static_cast<double>(rates.size());
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(common / count, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& covariances = parts.singularValues();
  const double hand = (parts.matrixU() * parts.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Vector3d turning(1, 1, hand), mirroring(1, 1, -hand);
  const auto differenceWith = [&](const Eigen::Vector3d& signs) {
    return std::sqrt(std::max(0.0, squares / count - 2 * signs.dot(covariances)));
  };
  const Eigen::Matrix3d rotation = parts.matrixU() * turning.asDiagonal() * parts.matrixV().transpose();
  alignment.imu_R_camera = Eigen::Quaterniond(rotation).normalized();
  alignment.rate_bias = mean.gyroscope - alignment.imu_R_camera * mean.camera;
  alignment.axes = parts.matrixV();
  alignment.common_rates = covariances.cwiseSqrt();
  alignment.difference = differenceWith(turning);
  alignment.mirrored_difference = differenceWith(mirroring);
  return alignment;
}

}  // namespace

TurnAlignment alignTurns(const std::vector<CameraTurn>& turns, const std::vector<InertialSample>& samples,
                         double offset_s) {
  const GyroscopeTurns gyroscope(samples, Eigen::Vector3d::Zero());
  const int reach = static_cast<int>(std::lround(longest_offset_tried_s / offset_step_s));
  const auto leastDifference = [](const TurnAlignment& alignment) {
    return std::min(alignment.difference, alignment.mirrored_difference);
  };
  TurnAlignment best;
  for (int step = -reach; step <= reach; ++step) {
    const double tried_s = offset_s + step * offset_step_s;
    const std::vector<Rates> rates = ratesOf(turns, gyroscope, tried_s);
    if (rates.size() < std::max(fewest_turns, turns.size() / 2)) continue;
    TurnAlignment alignment = alignedRates(withoutOutliers(rates), tried_s);
    alignment.is_at_end = std::abs(step) == reach;
    if (best.turns == 0 || leastDifference(alignment) < leastDifference(best)) best = alignment;
  }
  return best;
}

}  // namespace edgeslam
