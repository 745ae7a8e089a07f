#include "system/bad_frames/measured_poses.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "geometry/similarity.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

constexpr double chi_square_99 = 11.345;  // 3 degrees of freedom

// Of a row of CSV; what is quoted may hold commas.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

std::size_t columnOf(const std::vector<std::string>& heading, const std::string& name) {
  const auto found = std::find(heading.begin(), heading.end(), name);
  if (found == heading.end()) throw std::runtime_error("frames.csv has no column " + name);
  return static_cast<std::size_t>(found - heading.begin());
}

bool isGood(const std::string& state) { return state == "tracking" || state == "recovered" || state == "relocalised"; }

Eigen::Vector3d truePosition(const Trajectory& truth, std::int64_t time_ns) {
  constexpr std::int64_t tolerance_ns = 1'000'000;
  const auto found = std::lower_bound(truth.begin(), truth.end(), time_ns - tolerance_ns,
                                      [](const StampedPose& pose, std::int64_t time) { return pose.time_ns < time; });
  if (found == truth.end() || found->time_ns > time_ns + tolerance_ns) throw std::runtime_error("no ground truth");
  return found->world_T_camera.translation;
}

// Similarity with least weighted squares of to - (s R from + t) (Umeyama 1991).
Similarity alignWeighted(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                         const std::vector<double>& weights) {
  double weight = 0;
  Eigen::Vector3d from_mean = Eigen::Vector3d::Zero(), to_mean = from_mean;
  for (std::size_t i = 0; i < from.size(); ++i) {
    weight += weights[i];
    from_mean += weights[i] * from[i], to_mean += weights[i] * to[i];
  }
  from_mean /= weight, to_mean /= weight;
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  double spread = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    product += weights[i] * (to[i] - to_mean) * (from[i] - from_mean).transpose();
    spread += weights[i] * (from[i] - from_mean).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  Similarity result;
  result.rotation = Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose()));
  result.scale = (result.rotation.toRotationMatrix() * product.transpose()).trace() / spread;
  result.translation = to_mean - result.scale * (result.rotation * from_mean);
  return result;
}

}  // namespace

std::vector<MeasuredPose> readMeasuredPoses(const std::string& result) {
  std::istringstream table(fileContent(result + "/frames.csv"));
  std::string line;
  std::getline(table, line);
  const std::vector<std::string> heading = fieldsOf(line);
  const std::size_t time = columnOf(heading, "time_s"), state = columnOf(heading, "state");
  const std::size_t live = columnOf(heading, "live_x"), sigma = columnOf(heading, "sigma_x");
  std::vector<MeasuredPose> poses;
  for (int frame = 0; std::getline(table, line); ++frame) {
    const std::vector<std::string> fields = fieldsOf(line);
    if (fields.size() != heading.size()) throw std::runtime_error("frames.csv: a row is cut off: " + line);
    if (!isGood(fields[state])) continue;
    std::array<double, 7> pose{};
    for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = std::stod(fields[live + i]);
    MeasuredPose measured;
    measured.frame = frame;
    measured.time_ns = std::llround(std::stod(fields[time]) * 1e9);
    measured.map_T_camera.translation = {pose[0], pose[1], pose[2]};
    measured.map_T_camera.rotation = Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      measured.sigma[static_cast<Eigen::Index>(i)] = std::stod(fields[sigma + i]);
    }
    if (!(measured.sigma.minCoeff() > 0)) throw std::runtime_error("frames.csv: a good pose without sigmas: " + line);
    poses.push_back(measured);
  }
  return poses;
}

Honesty honestyOf(const std::vector<MeasuredPose>& poses, const Trajectory& truth) {
  Honesty honesty;
  honesty.poses = static_cast<int>(poses.size());
  if (poses.size() < 3) return honesty;
  std::vector<Eigen::Vector3d> measured, actual;
  std::vector<double> weights, sigmas;
  for (const MeasuredPose& pose : poses) {
    measured.push_back(pose.map_T_camera.translation);
    actual.push_back(truePosition(truth, pose.time_ns));
    weights.push_back(1 / pose.sigma.squaredNorm());
    sigmas.push_back(pose.sigma.maxCoeff());
  }
  const Similarity map_T_world = alignWeighted(measured, actual, weights).inverse();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d error = poses[i].map_T_camera.rotation.conjugate() * (map_T_world * actual[i] - measured[i]);
    const double squared = error.cwiseQuotient(poses[i].sigma).squaredNorm();
    honesty.normalised_error += squared / 3 / static_cast<double>(poses.size());
    honesty.largest_error = std::max(honesty.largest_error, error.norm() / map_T_world.scale);
    if (squared > chi_square_99) honesty.outside.push_back(poses[i].frame);
  }
  honesty.share_within = 1 - static_cast<double>(honesty.outside.size()) / static_cast<double>(poses.size());
  std::nth_element(sigmas.begin(), sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2), sigmas.end());
  honesty.median_sigma = sigmas[sigmas.size() / 2];
  return honesty;
}

}  // namespace edgeslam
