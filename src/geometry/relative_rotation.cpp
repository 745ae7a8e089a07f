#include "geometry/relative_rotation.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "geometry/median.h"
#include "geometry/pose.h"

namespace edgeslam {
namespace {

constexpr int most_rounds = 15;
constexpr double trim_factor = 2.5;  // matches with an error beyond this many medians are left out of the next round

Eigen::Quaterniond kabsch(const std::vector<Eigen::Vector3d>& first, const std::vector<Eigen::Vector3d>& second,
                          const std::vector<double>& errors, double largest_error) {
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (errors[i] <= largest_error) correlation += second[i] * first[i].transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if (u.determinant() * svd.matrixV().determinant() < 0) u.col(2) *= -1;
  return Eigen::Quaterniond(Eigen::Matrix3d(u * svd.matrixV().transpose())).normalized();
}

}  // namespace

RelativeRotation relativeRotation(const std::vector<Eigen::Vector3d>& first,
                                  const std::vector<Eigen::Vector3d>& second) {
  assert(first.size() == second.size());
  RelativeRotation result{Eigen::Quaterniond::Identity(), 0};
  if (first.empty()) return result;
  std::vector<double> errors(first.size(), 0.0);
  double largest_error = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const Eigen::Quaterniond previous = result.rotation;
    result.rotation = kabsch(first, second, errors, largest_error);
    for (std::size_t i = 0; i < first.size(); ++i) {
      const Eigen::Vector3d rotated = result.rotation * first[i];
      errors[i] = std::atan2(rotated.cross(second[i]).norm(), rotated.dot(second[i]));
    }
    result.median_error = upperMedian(std::vector<double>(errors));
    largest_error = std::max(trim_factor * result.median_error, 1e-12);
    if (round > 0 && rotationAngle(previous, result.rotation) < 1e-10) break;
  }
  return result;
}

}  // namespace edgeslam
