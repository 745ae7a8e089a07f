#include "mapping/time_offset_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "inertia/pose_errors.h"
#include "inertia/turn_fit.h"

namespace edgeslam {
namespace {

// Long against the errors of single poses, short against the time in which a hand turns to and fro.
constexpr double turn_s = 0.2;
constexpr double tried_step_s = 0.01;       // between offsets that are tried, from each of which the next is reached
constexpr std::size_t tried_every = 3;      // turn of those that overlap, for the trials
constexpr double largest_difference = 0.5;  // of what the gyroscope does not contradict, share of the turns

struct Difference {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // the bias [rad/s]
  double cost = 0;                                 // mean of its robust squares without the bias
  double turned = 0;                               // the same of the camera's rates
  std::size_t turns = 0;
};

// Of mean rates, the gyroscope's less the camera's; a bias is the same throughout.
Difference differenceWith(double offset_s, const std::vector<CameraTurn>& turns, const GyroscopeTurns& gyroscope,
                          const Eigen::Quaterniond& imu_R_camera) {
  const std::int64_t offset_ns = std::llround(offset_s * 1e9);
  std::vector<Eigen::Vector3d> differences, rates;
  for (std::size_t i = 0; i < turns.size(); i += tried_every) {
    const std::optional<GyroscopeTurn> felt =
        gyroscope.between(turns[i].from_ns + offset_ns, turns[i].to_ns + offset_ns);
    if (!felt) continue;
    rates.push_back(imu_R_camera * rotationLog(turns[i].rotation) / secondsOf(turns[i]));
    differences.push_back(rotationLog(felt->rotation) / secondsOf(turns[i]) - rates.back());
  }
  Difference difference;
  difference.turns = differences.size();
  if (differences.empty()) return difference;
  const auto count = static_cast<double>(differences.size());
  Eigen::Vector3d mean_rate = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < differences.size(); ++i) {
    difference.mean += differences[i] / count;
    mean_rate += rates[i] / count;
  }
  for (std::size_t i = 0; i < differences.size(); ++i) {
    difference.cost += (differences[i] - difference.mean).squaredNorm() / count;
    difference.turned += (rates[i] - mean_rate).squaredNorm() / count;
  }
  return difference;
}

}  // namespace

std::optional<TimeOffsetEstimate> estimateTimeOffset(const std::vector<PosedCamera>& frames,
                                                     const std::vector<InertialSample>& samples,
                                                     const InertialUnit& unit, double given_s, double farthest_s) {
  const std::vector<CameraTurn> turns = cameraTurns(frames, turn_s);
  if (turns.size() < fewest_turns || samples.empty()) return std::nullopt;
  const Eigen::Quaterniond& imu_R_camera = unit.imu_T_camera.rotation;
  const GyroscopeTurns gyroscope(samples, Eigen::Vector3d::Zero());
  const int reach = static_cast<int>(std::lround(farthest_s / tried_step_s));
  Difference best;
  double best_s = given_s;
  for (int step = -reach; step <= reach; ++step) {
    const double tried_s = given_s + step * tried_step_s;
    const Difference difference = differenceWith(tried_s, turns, gyroscope, imu_R_camera);
    if (difference.turns * tried_every < turns.size() / 2 || difference.turns == 0) continue;
    if (best.turns > 0 && !(difference.cost < best.cost)) continue;
    best = difference;
    best_s = tried_s;
  }
  if (best.turns == 0 || !(best.cost < largest_difference * largest_difference * best.turned)) return std::nullopt;
  const std::optional<TurnFit> fit =
      fitTurns(turns, samples, {imu_R_camera, best.mean, best_s}, unit.rate_walk, /*rotation_is_known=*/true);
  if (!fit || !fit->covariance.allFinite() || !(std::abs(fit->parameters.offset_s - given_s) < farthest_s)) {
    return std::nullopt;
  }
  return TimeOffsetEstimate{fit->parameters.offset_s, std::sqrt(fit->covariance(6, 6)), fit->seconds};
}

}  // namespace edgeslam
