// Nister's five-point algorithm (2004) in RANSAC, as OpenCV has it, on bearings; then a robust least-squares refinement
// of the relative pose over all correspondences.
#include "geometry/epipolar.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <random>

#include "geometry/median.h"
#include "geometry/relative_rotation.h"
#include "geometry/robust_estimation.h"
#include "geometry/tangents.h"

namespace edgeslam {
namespace {

using Bearings = std::vector<Eigen::Vector3d>;

constexpr int least_matches = 8;
constexpr double rotation_only_from = 0.9;  // share of matches from which a rotation explains all there is
constexpr int ransac_iterations = 1000;     // at most

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Sampson's distance on the sphere [rad]: how far the two bearings together must turn to meet the epipolar constraint.
double epipolarError(const Pose& second_T_first, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  const Eigen::Vector3d turned = second_T_first.rotation * first;
  const Eigen::Vector3d plane_of_first = second_T_first.translation.cross(turned);
  const Eigen::Vector3d plane_of_second = second_T_first.translation.cross(second);
  const double weight = plane_of_first.squaredNorm() + plane_of_second.squaredNorm();
  return weight > 0 ? std::abs(second.dot(plane_of_first)) / std::sqrt(weight) : 0.0;
}

// True where the rays meet in front of both cameras, or are parallel but for the noise.
bool inFront(const Pose& second_T_first, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
             double threshold) {
  const Eigen::Vector3d turned = second_T_first.rotation * first;
  if (angleBetween(turned, second) < 2 * threshold) return true;
  const double cosine = turned.dot(second);
  const double along_first = turned.dot(second_T_first.translation);
  const double along_second = second.dot(second_T_first.translation);
  return cosine * along_second > along_first && along_second > cosine * along_first;
}

int markInliers(const Pose& second_T_first, const Bearings& first, const Bearings& second, double threshold,
                std::vector<char>* inliers) {
  int count = 0;
  inliers->assign(first.size(), 0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!(epipolarError(second_T_first, first[i], second[i]) < threshold)) continue;
    if (!inFront(second_T_first, first[i], second[i], threshold)) continue;
    (*inliers)[i] = 1;
    ++count;
  }
  return count;
}

// The matches that have a place on the normalized image plane, there, in an order drawn by the seed: OpenCV's own
// random numbers are fixed, so the seed acts through the order.
struct NormalizedMatches {
  std::vector<cv::Point2d> first, second;
};

NormalizedMatches shuffled(const Bearings& first, const Bearings& second, std::uint64_t seed) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].z() >= least_z && second[i].z() >= least_z) order.push_back(i);
  }
  std::mt19937_64 random(seed);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  NormalizedMatches matches;
  for (const std::size_t i : order) {
    matches.first.emplace_back(first[i].x() / first[i].z(), first[i].y() / first[i].z());
    matches.second.emplace_back(second[i].x() / second[i].z(), second[i].y() / second[i].z());
  }
  return matches;
}

Eigen::Matrix3d toEigen(const cv::Mat& matrix) {
  Eigen::Matrix3d result;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) result(row, col) = matrix.at<double>(row, col);
  }
  return result;
}

// The four poses of an essential matrix.
std::vector<Pose> posesOfEssential(const Eigen::Matrix3d& essential) {
  if (!essential.allFinite() || !(essential.norm() > 0)) return {};
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU(), v = svd.matrixV();
  if (u.determinant() < 0) u = -u;
  if (v.determinant() < 0) v = -v;
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  std::vector<Pose> poses;
  for (const Eigen::Matrix3d& turn : {quarter_turn, Eigen::Matrix3d(quarter_turn.transpose())}) {
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(Eigen::Matrix3d(u * turn * v.transpose())).normalized();
    poses.push_back({rotation, u.col(2)});
    poses.push_back({rotation, -u.col(2)});
  }
  return poses;
}

std::vector<Pose> fivePoint(const NormalizedMatches& matches, double threshold) {
  const cv::Mat essential = cv::findEssentialMat(matches.first, matches.second, cv::Mat::eye(3, 3, CV_64F), cv::RANSAC,
                                                 ransac_confidence, threshold, ransac_iterations);
  if (essential.rows < 3 || essential.cols != 3) return {};
  return posesOfEssential(toEigen(essential));
}

// The poses that see one plane move as the matches do. On a plane two essential matrices fit every match, of which the
// five-point algorithm returns either; often only one has the points in front of both cameras.
std::vector<Pose> planePoses(const NormalizedMatches& matches, double threshold) {
  const cv::Mat homography =
      cv::findHomography(matches.first, matches.second, cv::RANSAC, 2 * threshold, cv::noArray(), ransac_iterations);
  if (homography.empty() || !toEigen(homography).allFinite()) return {};
  std::vector<cv::Mat> rotations, translations, normals;
  cv::decomposeHomographyMat(homography, cv::Mat::eye(3, 3, CV_64F), rotations, translations, normals);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Matrix3d rotation = toEigen(rotations[i]);
    const Eigen::Vector3d translation(translations[i].at<double>(0), translations[i].at<double>(1),
                                      translations[i].at<double>(2));
    if (!rotation.allFinite() || !(translation.norm() > 1e-9)) continue;
    poses.push_back({Eigen::Quaterniond(rotation).normalized(), translation.normalized()});
  }
  return poses;
}

// Of several poses, the one with the most matches in front of both cameras.
Pose mostInFront(const std::vector<Pose>& poses, const Bearings& first, const Bearings& second, double threshold) {
  Pose best;
  int best_count = -1;
  std::vector<char> inliers;
  for (const Pose& pose : poses) {
    const int count = markInliers(pose, first, second, threshold, &inliers);
    if (count <= best_count) continue;
    best_count = count;
    best = pose;
  }
  return best;
}

// Normal equations of the epipolar errors in 5 unknowns (rotation vector on the left; translation along its two
// tangents) with Tukey's weights of width `width` [rad].
struct EpipolarSystem {
  Eigen::Matrix<double, 5, 5> hessian = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> gradient = Eigen::Matrix<double, 5, 1>::Zero();
  double cost = 0;
};

EpipolarSystem epipolarSystem(const Pose& pose, const Eigen::Matrix<double, 3, 2>& tangents, const Bearings& first,
                              const Bearings& second, double width) {
  EpipolarSystem system;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Eigen::Vector3d turned = pose.rotation * first[i];
    const double normalizer =
        pose.translation.cross(turned).squaredNorm() + pose.translation.cross(second[i]).squaredNorm();
    const double constraint = pose.translation.dot(turned.cross(second[i]));
    const double squared = normalizer > 0 ? constraint * constraint / normalizer : 0.0;
    const double closeness = 1 - squared / (width * width);
    system.cost += closeness > 0 ? 1 - closeness * closeness * closeness : 1.0;
    if (!(closeness > 0) || !(normalizer > 0)) continue;
    Eigen::Matrix<double, 5, 1> derivative;
    derivative.head<3>() = second[i] * pose.translation.dot(turned) - pose.translation * second[i].dot(turned);
    derivative.tail<2>() = tangents.transpose() * turned.cross(second[i]);
    const double weight = closeness * closeness / normalizer;
    system.hessian += weight * derivative * derivative.transpose();
    system.gradient += weight * constraint * derivative;
  }
  return system;
}

// Levenberg-Marquardt from RANSAC's pose, which rests on five matches, over all matches.
Pose refine(Pose pose, const Bearings& first, const Bearings& second, double width) {
  double damping = 1e-6;
  Eigen::Matrix<double, 3, 2> tangents = tangentsOf(pose.translation);
  EpipolarSystem system = epipolarSystem(pose, tangents, first, second, width);
  for (int iteration = 0; iteration < most_refinements; ++iteration) {
    Eigen::Matrix<double, 5, 5> damped = system.hessian;
    damped.diagonal() += damping * (system.hessian.diagonal().array() + 1e-12).matrix();
    const Eigen::Matrix<double, 5, 1> step = -damped.ldlt().solve(system.gradient);
    if (!step.allFinite() || step.norm() < 1e-10) break;
    const Pose next{(rotationExp(step.head<3>()) * pose.rotation).normalized(),
                    (pose.translation + tangents * step.tail<2>()).normalized()};
    const Eigen::Matrix<double, 3, 2> next_tangents = tangentsOf(next.translation);
    const EpipolarSystem next_system = epipolarSystem(next, next_tangents, first, second, width);
    if (next_system.cost < system.cost) {
      pose = next;
      tangents = next_tangents;
      system = next_system;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping *= 100;
    }
  }
  return pose;
}

// Median angle [rad] between the rays of the inliers once the rotation is taken away; 0 without inliers.
double medianParallax(const Eigen::Quaterniond& rotation, const Bearings& first, const Bearings& second,
                      const std::vector<char>& inliers) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (inliers[i]) angles.push_back(angleBetween(rotation * first[i], second[i]));
  }
  return angles.empty() ? 0 : upperMedian(angles);
}

// A rotation explains a match where each bearing need turn by half the remaining angle, which makes it comparable to
// `epipolarError`.
int markRotationInliers(const Eigen::Quaterniond& rotation, const Bearings& first, const Bearings& second,
                        double threshold, std::vector<char>* inliers) {
  int count = 0;
  inliers->assign(first.size(), 0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!(angleBetween(rotation * first[i], second[i]) < std::sqrt(2.0) * threshold)) continue;
    (*inliers)[i] = 1;
    ++count;
  }
  return count;
}

}  // namespace

RelativePose relativePose(const Bearings& first, const Bearings& second, double threshold, std::uint64_t seed) {
  assert(first.size() == second.size());
  RelativePose result;
  result.inliers.assign(first.size(), 0);
  if (first.size() < least_matches) return result;

  result.second_T_first.rotation = relativeRotation(first, second).rotation;
  result.inlier_count = markRotationInliers(result.second_T_first.rotation, first, second, threshold, &result.inliers);
  result.rotation_only_share = static_cast<double>(result.inlier_count) / static_cast<double>(first.size());
  result.parallax = medianParallax(result.second_T_first.rotation, first, second, result.inliers);
  if (result.rotation_only_share > rotation_only_from) return result;

  const NormalizedMatches matches = shuffled(first, second, seed);
  if (matches.first.size() < least_matches) return result;
  int best_count = 0;
  std::vector<char> inliers;
  for (const std::vector<Pose>& poses : {fivePoint(matches, threshold), planePoses(matches, threshold)}) {
    if (poses.empty()) continue;
    const Pose pose = refine(mostInFront(poses, first, second, threshold), first, second, 2 * threshold);
    const int count = markInliers(pose, first, second, threshold, &inliers);
    if (count <= best_count) continue;
    best_count = count;
    result.second_T_first = pose;
    result.inliers = inliers;
  }
  if (best_count < least_matches) return result;
  result.found = true;
  result.inlier_count = best_count;
  result.parallax = medianParallax(result.second_T_first.rotation, first, second, result.inliers);
  return result;
}

}  // namespace edgeslam
