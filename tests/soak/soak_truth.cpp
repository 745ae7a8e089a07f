#include "soak/soak_truth.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "geometry/median.h"
#include "geometry/similarity.h"

namespace edgeslam {
namespace {

constexpr std::size_t fewest_poses = 10;
constexpr double bound_of_99 = 11.345;  // of chi squared with three degrees of freedom
constexpr double wrong = 0.1;           // of the extent
constexpr double agreeing = 3;          // median distances
constexpr int alignments = 3;
constexpr double most_wrong_share = 0.01;
constexpr double most_growth = 1.5, most_growth_m = 0.01;

std::vector<JudgedPose> ofLargestWorld(const std::vector<JudgedPose>& poses) {
  std::map<int, std::size_t> worlds;
  for (const JudgedPose& pose : poses) ++worlds[pose.world];
  if (worlds.empty()) return {};
  const int largest = std::max_element(worlds.begin(), worlds.end(), [](const auto& a, const auto& b) {
                        return a.second < b.second;
                      })->first;
  std::vector<JudgedPose> chosen;
  for (const JudgedPose& pose : poses) {
    if (pose.world == largest) chosen.push_back(pose);
  }
  return chosen;
}

double distance(const Similarity& truth_S_world, const JudgedPose& pose) {
  return (truth_S_world * pose.world_T_camera.translation - pose.truth).norm();
}

Similarity laidOnTruth(const std::vector<JudgedPose>& poses) {
  Similarity truth_S_world;
  double farthest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < alignments; ++i) {
    std::vector<Eigen::Vector3d> from, to;
    std::vector<double> distances;
    for (const JudgedPose& pose : poses) {
      if (i > 0 && distance(truth_S_world, pose) > farthest) continue;
      from.push_back(pose.world_T_camera.translation);
      to.push_back(pose.truth);
    }
    truth_S_world = alignHorn(from, to);
    for (const JudgedPose& pose : poses) distances.push_back(distance(truth_S_world, pose));
    farthest = agreeing * upperMedian(distances);
  }
  return truth_S_world;
}

// Of where the camera was: the diagonal of its box [m].
double extentOf(const std::vector<JudgedPose>& poses) {
  Eigen::Vector3d low = poses[0].truth, high = low;
  for (const JudgedPose& pose : poses) {
    low = low.cwiseMin(pose.truth);
    high = high.cwiseMax(pose.truth);
  }
  return (high - low).norm();
}

// In standard deviations, squared.
double surprise(const Similarity& truth_S_world, const JudgedPose& pose) {
  const Eigen::Vector3d in_world = truth_S_world.inverse() * pose.truth - pose.world_T_camera.translation;
  const Eigen::Vector3d in_camera = pose.world_T_camera.rotation.conjugate() * in_world;
  return in_camera.dot(pose.world_covariance.topLeftCorner<3, 3>().ldlt().solve(in_camera));
}

}  // namespace

SoakTruth judgeByTruth(const std::vector<JudgedPose>& poses) {
  SoakTruth result;
  const std::vector<JudgedPose> judged = ofLargestWorld(poses);
  if (judged.size() < fewest_poses) return result;
  const Similarity truth_S_world = laidOnTruth(judged);
  const double extent = extentOf(judged);
  const auto count = static_cast<double>(judged.size());
  double squared = 0;
  for (const JudgedPose& pose : judged) {
    const double off = distance(truth_S_world, pose);
    const bool is_beyond = surprise(truth_S_world, pose) > bound_of_99;
    squared += off * off;
    if (is_beyond) result.beyond_share += 1 / count;
    if (is_beyond && off > wrong * extent) result.wrong_share += 1 / count;
  }
  result.poses = judged.size();
  result.error_m = std::sqrt(squared / count);
  return result;
}

std::string truthHeading() { return "pass,sequence,poses,error_m,beyond_share,wrong_share\n"; }

std::string truthLine(const SoakTruth& t) {
  char text[200];
  std::snprintf(text, sizeof(text), "%lld,%.100s,%zu,%.5f,%.4f,%.4f\n", static_cast<long long>(t.pass),
                t.sequence.c_str(), t.poses, t.error_m, t.beyond_share, t.wrong_share);
  return text;
}

std::vector<std::string> truthProblems(const std::vector<SoakTruth>& passes) {
  std::vector<std::string> problems;
  if (passes.empty()) return problems;
  const std::int64_t last = passes.back().pass, third = std::max<std::int64_t>(1, last / 3);
  std::map<std::string, std::vector<double>> early, late;
  char text[200];
  for (const SoakTruth& pass : passes) {
    if (pass.wrong_share > most_wrong_share) {
      std::snprintf(text, sizeof(text), "%.100s: %.1f %% of the poses of pass %lld are wrong and called good",
                    pass.sequence.c_str(), 100 * pass.wrong_share, static_cast<long long>(pass.pass));
      problems.emplace_back(text);
    }
    if (pass.poses == 0 || pass.pass % 2 == 0) continue;
    if (pass.pass <= third) early[pass.sequence].push_back(pass.error_m);
    if (pass.pass > last - third) late[pass.sequence].push_back(pass.error_m);
  }
  for (const auto& [name, errors] : late) {
    const auto before = early.find(name);
    if (before == early.end()) continue;
    const double from = medianOr(0.0, before->second), to = medianOr(0.0, errors);
    if (to <= most_growth * from + most_growth_m) continue;
    std::snprintf(text, sizeof(text), "%.100s: error [m] grew from %.4f to %.4f", name.c_str(), from, to);
    problems.emplace_back(text);
  }
  return problems;
}

}  // namespace edgeslam
