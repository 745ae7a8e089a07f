// EPnP needs a consensus to work on: P3P samples find it, EPnP and least squares over it make the pose.
#include "geometry/resectioning.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

#include "geometry/robust_estimation.h"
#include "geometry/squared.h"
#include "geometry/three_point_pose.h"

namespace edgeslam {
namespace {

using Points = Vectors3;
using Indices = std::pmr::vector<std::size_t>;

constexpr std::size_t least_points = 6;
constexpr std::size_t sample_size = 4;  // three for P3P, one to choose among its solutions

// Correspondences in the form OpenCV asks for, with the identity as camera matrix.
struct Normalized {
  std::vector<cv::Point3d> points;  // world
  std::vector<cv::Point2d> pixels;  // camera, z = 1
};

Normalized normalized(const Points& points, const Points& bearings, const Indices& chosen) {
  Normalized result;
  for (const std::size_t i : chosen) {
    result.points.emplace_back(points[i].x(), points[i].y(), points[i].z());
    result.pixels.emplace_back(bearings[i].x() / bearings[i].z(), bearings[i].y() / bearings[i].z());
  }
  return result;
}

// Whether the angle between where a point is seen and its bearing is below a threshold.
class Agreement {
 public:
  // `threshold`: below a right angle [rad].
  Agreement(const Pose& camera_T_world, double threshold)
      : camera_R_world_(camera_T_world.rotation.toRotationMatrix()),
        translation_(camera_T_world.translation),
        square_of_tangent_(squared(std::tan(threshold))) {
    assert(threshold < 0.5 * M_PI);
  }

  bool operator()(const Eigen::Vector3d& point, const Eigen::Vector3d& bearing) const {
    const Eigen::Vector3d seen = camera_R_world_ * point + translation_;
    const double along = seen.dot(bearing);
    return along > 0 && seen.cross(bearing).squaredNorm() < square_of_tangent_ * along * along;
  }

 private:
  Eigen::Matrix3d camera_R_world_;
  Eigen::Vector3d translation_;
  double square_of_tangent_;
};

// Those of `among` within `threshold` [rad] under a pose.
Indices within(const Pose& camera_T_world, const Points& points, const Points& bearings, const Indices& among,
               double threshold) {
  const Agreement agrees(camera_T_world, threshold);
  Indices kept(among.get_allocator());
  kept.reserve(among.size());
  for (const std::size_t i : among) {
    if (agrees(points[i], bearings[i])) kept.push_back(i);
  }
  return kept;
}

// How many of `among` agree; given up where it can no longer be more than `beaten`.
std::size_t countMore(std::size_t beaten, const Agreement& agrees, const Points& points, const Points& bearings,
                      const Indices& among) {
  std::size_t count = 0, left = among.size();
  for (const std::size_t i : among) {
    if (count + left <= beaten) break;
    --left;
    if (agrees(points[i], bearings[i])) ++count;
  }
  return count;
}

Pose poseOf(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const Eigen::Vector3d rotation(rotation_vector.at<double>(0), rotation_vector.at<double>(1),
                                 rotation_vector.at<double>(2));
  return {rotationExp(rotation), {translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)}};
}

// Points on one line, or in one place, leave the camera free to turn about it.
bool spanPlane(const Points& points, const Indices& chosen) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t i : chosen) mean += points[i] / static_cast<double>(chosen.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::size_t i : chosen) scatter += (points[i] - mean) * (points[i] - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d spread = solver.eigenvalues();
  return spread(1) > 1e-8 * spread(2) && spread(2) > 1e-20 * mean.squaredNorm();
}

// The first `sample_size` of `order` become a random sample of it.
void drawSample(Indices* order, std::mt19937_64* random) {
  for (std::size_t k = 0; k < sample_size; ++k) {
    std::swap((*order)[k], (*order)[k + (*random)() % (order->size() - k)]);
  }
}

// Iterations after which RANSAC has seen a sample of inliers alone with the confidence asked for.
double iterationsNeeded(std::size_t inliers, std::size_t all) {
  const double share = std::pow(static_cast<double>(inliers) / static_cast<double>(all), sample_size);
  return share >= 1 ? 1.0 : std::log(1 - ransac_confidence) / std::log1p(-share);
}

// RANSAC on minimal samples: P3P, the pose with the most inliers. EPnP itself needs more points, and fails on samples
// of them that lie in one plane.
Pose sampleConsensus(const Points& points, const Points& bearings, const Indices& usable, double threshold,
                     std::uint64_t seed, int iterations) {
  Pose best;
  std::size_t best_count = 0;
  std::mt19937_64 random(seed);
  Indices order(usable, usable.get_allocator());
  for (int iteration = 0; iteration < iterations; ++iteration) {
    drawSample(&order, &random);
    const std::size_t fourth = order[3];
    const ThreePointPoses poses = posesFromThreePoints({points[order[0]], points[order[1]], points[order[2]]},
                                                       {bearings[order[0]], bearings[order[1]], bearings[order[2]]});
    for (int k = 0; k < poses.count; ++k) {
      const Pose& candidate = poses.camera_T_world[static_cast<std::size_t>(k)];
      const Agreement agrees(candidate, threshold);
      if (!agrees(points[fourth], bearings[fourth])) continue;
      const std::size_t count = countMore(best_count, agrees, points, bearings, usable);
      if (count <= best_count) continue;
      best_count = count;
      best = candidate;
    }
    if (iteration + 1 >= iterationsNeeded(best_count, usable.size())) break;
  }
  return best;
}

// EPnP over the correspondences within the threshold; the given pose where it does not gain any.
Pose overConsensus(const Pose& pose, const Points& points, const Points& bearings, const Indices& usable,
                   double threshold) {
  const Indices inliers = within(pose, points, bearings, usable, threshold);
  if (inliers.size() < least_points) return pose;
  const Normalized consensus = normalized(points, bearings, inliers);
  cv::Mat rotation_vector, translation;
  cv::solvePnP(consensus.points, consensus.pixels, cv::Matx33d::eye(), cv::noArray(), rotation_vector, translation,
               false, cv::SOLVEPNP_EPNP);
  const Pose candidate = poseOf(rotation_vector, translation);
  const std::size_t agree = countMore(inliers.size() - 1, Agreement(candidate, threshold), points, bearings, usable);
  return agree >= inliers.size() ? candidate : pose;
}

// Normal equations of the errors [rad] of the bearings, across each, with Tukey's weights of width `width` [rad].
struct BearingSystem {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0;
};

BearingSystem bearingSystem(const Pose& pose, const Points& points, const Points& bearings, const Indices& among,
                            double width) {
  BearingSystem system;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (const std::size_t i : among) {
    const Eigen::Vector3d seen = pose * points[i];
    const double distance = seen.norm();
    const Eigen::Vector3d direction = seen / distance;
    const Eigen::Vector3d error = direction - bearings[i];  // its length is the angle, to first order
    const double closeness = 1 - error.squaredNorm() / (width * width);
    system.cost += closeness > 0 ? 1 - closeness * closeness * closeness : 1.0;
    if (!(closeness > 0)) continue;
    Eigen::Matrix<double, 3, 6> seen_by_update;
    seen_by_update << rotation, -rotation * skew(points[i]);
    const Eigen::Matrix<double, 3, 6> derivative =
        (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / distance * seen_by_update;
    const double weight = closeness * closeness;
    system.hessian += weight * derivative.transpose() * derivative;
    system.gradient += weight * derivative.transpose() * error;
  }
  return system;
}

// Levenberg-Marquardt on the bearings themselves, which unlike the normalized plane weighs all directions alike.
Pose refine(Pose pose, const Points& points, const Points& bearings, const Indices& among, double width) {
  double damping = 1e-6;
  BearingSystem system = bearingSystem(pose, points, bearings, among, width);
  for (int iteration = 0; iteration < most_refinements; ++iteration) {
    Matrix6d damped = system.hessian;
    damped.diagonal() += damping * (system.hessian.diagonal().array() + 1e-12).matrix();
    const Vector6d step = -damped.ldlt().solve(system.gradient);
    if (!step.allFinite() || step.norm() < 1e-12) break;
    const Pose next = retract(pose, step);
    const BearingSystem next_system = bearingSystem(next, points, bearings, among, width);
    if (next_system.cost < system.cost) {
      pose = next;
      system = next_system;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping *= 100;
    }
  }
  return pose;
}

enum class Consensus { as_sampled, by_epnp };

ResectioningResult resectionFrom(Consensus consensus, const Points& points, const Points& bearings, double threshold,
                                 std::uint64_t seed, int iterations, std::pmr::memory_resource* memory) {
  assert(points.size() == bearings.size());
  ResectioningResult result(memory);
  result.inliers.assign(points.size(), 0);
  Indices finite(memory), usable(memory);
  finite.reserve(points.size());
  usable.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite() || !bearings[i].allFinite()) continue;
    finite.push_back(i);
    if (bearings[i].z() >= least_z) usable.push_back(i);
  }
  if (usable.size() < least_points || !spanPlane(points, usable)) return result;

  Pose pose = sampleConsensus(points, bearings, usable, threshold, seed, iterations);
  if (consensus == Consensus::by_epnp) pose = overConsensus(pose, points, bearings, usable, threshold);
  result.camera_T_world = refine(pose, points, bearings, finite, 2 * threshold);
  const Indices inliers = within(result.camera_T_world, points, bearings, finite, threshold);
  for (const std::size_t i : inliers) result.inliers[i] = 1;
  result.inlier_count = static_cast<int>(inliers.size());
  result.found = inliers.size() >= least_points && spanPlane(points, inliers);
  return result;
}

}  // namespace

ResectioningResult resection(const Points& points, const Points& bearings, double threshold, std::uint64_t seed,
                             int iterations) {
  return resectionFrom(Consensus::by_epnp, points, bearings, threshold, seed, iterations,
                       std::pmr::get_default_resource());
}

ResectioningResult resectionBySamples(const Points& points, const Points& bearings, double threshold,
                                      std::uint64_t seed, int iterations, std::pmr::memory_resource* memory) {
  return resectionFrom(Consensus::as_sampled, points, bearings, threshold, seed, iterations, memory);
}

}  // namespace edgeslam
