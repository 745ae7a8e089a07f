#include "geometry/three_point_pose.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace edgeslam {
namespace {

using Quartic = std::array<double, 5>;  // coefficients, the constant one first

double valueOf(const Quartic& quartic, double x, double& slope) {
  double value = quartic[4];
  slope = 0;
  for (int i = 3; i >= 0; --i) {
    slope = slope * x + value;
    value = value * x + quartic[static_cast<std::size_t>(i)];
  }
  return value;
}

// A double root that noise has moved off the real axis counts as real.
int realRoots(const Quartic& quartic, std::array<double, 4>& roots) {
  constexpr double imaginary_share = 1e-3;
  double largest = 0;
  for (const double coefficient : quartic) largest = std::max(largest, std::abs(coefficient));
  if (!(std::abs(quartic[4]) > 1e-12 * largest)) return 0;
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 4; ++i) {
    companion(i, 3) = -quartic[static_cast<std::size_t>(i)] / quartic[4];
    if (i > 0) companion(i, i - 1) = 1;
  }
  if (!companion.allFinite()) return 0;
  const Eigen::EigenSolver<Eigen::Matrix4d> solver(companion, /*computeEigenvectors=*/false);
  if (solver.info() != Eigen::Success) return 0;
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    const std::complex<double> root = solver.eigenvalues()[i];
    if (std::abs(root.imag()) > imaginary_share * std::abs(root)) continue;
    double x = root.real();
    for (int step = 0; step < 2; ++step) {
      double slope = 0;
      const double value = valueOf(quartic, x, slope);
      if (std::abs(slope) > 1e-12 * largest) x -= value / slope;
    }
    roots[static_cast<std::size_t>(count++)] = x;
  }
  return count;
}

// Columns: an orthonormal frame that three points span. False where they lie on a line.
bool frameOf(const std::array<Eigen::Vector3d, 3>& points, Eigen::Matrix3d& frame) {
  const Eigen::Vector3d first = points[1] - points[0], second = points[2] - points[0];
  const Eigen::Vector3d normal = first.cross(second);
  if (!(normal.norm() > 1e-9 * first.norm() * second.norm())) return false;
  frame.col(0) = first.normalized();
  frame.col(2) = normal.normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return true;
}

}  // namespace

ThreePointPoses posesFromThreePoints(const std::array<Eigen::Vector3d, 3>& points,
                                     const std::array<Eigen::Vector3d, 3>& bearings) {
  ThreePointPoses poses;
  Eigen::Matrix3d world_frame, camera_frame;
  if (!frameOf(points, world_frame)) return poses;
  const double a2 = (points[1] - points[2]).squaredNorm(), b2 = (points[0] - points[2]).squaredNorm(),
               c2 = (points[0] - points[1]).squaredNorm();
  const double cos_a = bearings[1].dot(bearings[2]), cos_b = bearings[0].dot(bearings[2]),
               cos_c = bearings[0].dot(bearings[1]);
  const double difference = (a2 - c2) / b2, sum = (a2 + c2) / b2;
  // In the ratio of the third distance to the first.
  const Quartic quartic{
      (1 + difference) * (1 + difference) - 4 * a2 / b2 * cos_c * cos_c,
      4 * (-difference * (1 + difference) * cos_b + 2 * a2 / b2 * cos_c * cos_c * cos_b - (1 - sum) * cos_a * cos_c),
      2 * (difference * difference - 1 + 2 * difference * difference * cos_b * cos_b +
           2 * (b2 - c2) / b2 * cos_a * cos_a - 4 * sum * cos_a * cos_b * cos_c + 2 * (b2 - a2) / b2 * cos_c * cos_c),
      4 * (difference * (1 - difference) * cos_b - (1 - sum) * cos_a * cos_c + 2 * c2 / b2 * cos_a * cos_a * cos_b),
      (difference - 1) * (difference - 1) - 4 * c2 / b2 * cos_a * cos_a};
  std::array<double, 4> roots{};
  const int root_count = realRoots(quartic, roots);
  for (int i = 0; i < root_count; ++i) {
    const double third_ratio = roots[static_cast<std::size_t>(i)];
    const double divisor = 2 * (cos_c - third_ratio * cos_a);
    const double second_ratio =
        ((difference - 1) * third_ratio * third_ratio - 2 * difference * cos_b * third_ratio + 1 + difference) /
        divisor;
    const double square = b2 / (1 + third_ratio * third_ratio - 2 * third_ratio * cos_b);
    if (!(third_ratio > 0) || !(second_ratio > 0) || !(square > 0) || !std::isfinite(square * second_ratio)) continue;
    const double distance = std::sqrt(square);
    const std::array<Eigen::Vector3d, 3> seen{distance * bearings[0], distance * second_ratio * bearings[1],
                                              distance * third_ratio * bearings[2]};
    if (!frameOf(seen, camera_frame)) continue;
    const Eigen::Matrix3d rotation = camera_frame * world_frame.transpose();
    Pose& pose = poses.camera_T_world[static_cast<std::size_t>(poses.count++)];
    pose.rotation = Eigen::Quaterniond(rotation).normalized();
    pose.translation = (seen[0] + seen[1] + seen[2] - rotation * (points[0] + points[1] + points[2])) / 3;
  }
  return poses;
}

}  // namespace edgeslam
